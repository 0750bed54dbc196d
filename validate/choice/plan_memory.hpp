#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "workload_class.hpp"

namespace detp::validate {

struct RememberedChoice {
  Candidate candidate = {};
  int threads = 1;                ///< for which it was made
  double predicted_seconds = 0;   ///< of one search, sorting and building included
  double predicted_error = 0;     ///< standard error, seconds
  Rigor rigor = Rigor::estimate;  ///< reached
  bool cut_off = false;           ///< some technique could still win, but was not examined
  bool operator==(const RememberedChoice&) const = default;
};

/// Thrown if only a remembered choice may be used, and there is none. The message says what was wanted, and what there is.
class NotRemembered : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Choices by class of workload, for later plans on the same machine. Many threads may use one object at once. Prints
/// nothing. Read and written by plan_memory_file.hpp.
class PlanMemory {
 public:
  struct Entry {
    WorkloadClass workload;
    RememberedChoice choice;
    bool operator==(const Entry&) const = default;
  };

  /// Keeps the choice, unless a choice of higher rigor for this class is known, or one of the same rigor that was not cut
  /// off while this one was. Throws std::invalid_argument if a number is not finite or negative, for parameters out of
  /// range, for a technique that is not exact, and for threads out of 0 … 4096.
  void remember(const WorkloadClass& workload, const RememberedChoice& choice);

  /// The choice for the class, if its rigor is at least `least`.
  [[nodiscard]] std::optional<RememberedChoice> find(const WorkloadClass& workload, Rigor least) const;

  /// The same, but throws NotRemembered if there is none.
  [[nodiscard]] RememberedChoice require(const WorkloadClass& workload, Rigor least) const;

  [[nodiscard]] std::vector<Entry> entries() const;  ///< in the order of their classes
  [[nodiscard]] std::size_t size() const;

 private:
  mutable std::mutex mutex_;
  std::map<WorkloadClass, RememberedChoice> choices_;
};

}  // namespace detp::validate
