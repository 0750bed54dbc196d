#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "claim.hpp"
#include "detp/sim/ranks/farm.hpp"
#include "detp/validate/checkpoint/value_json.hpp"
#include "experiments.hpp"

/// Experiments that ranks share.
namespace detp::validate {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FormulaValue, form, source, value)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Finding, id, quantity, technique, parameters, predictions, observed, batches,
                                   tolerance, lines, seconds)

/// One of the experiments, and which of its repetitions: each has its own seed; number 0 has the experiment's.
struct Repetition {
  std::size_t step = 0;
  std::uint64_t number = 0;
};

struct FoundOnce {
  std::vector<Finding> findings;
  double seconds = 0;
  bool stopped = false;  ///< and has no findings
};

/// Runs experiments on the ranks of Experiment::ranks, or on this process alone.
class SharedFindings {
 public:
  /// Keeps references to both.
  SharedFindings(const Experiment& experiment, std::span<const ExperimentStep> steps);

  /// On rank 0. In the order of the repetitions. `costs`: as Farm::all.
  [[nodiscard]] std::vector<FoundOnce> find(const std::vector<Repetition>& repetitions,
                                            const std::vector<double>& costs = {});
  /// Repetitions that are found at the same time.
  [[nodiscard]] std::size_t at_once() const;
  /// On the other ranks. Returns when rank 0 has all that it needs.
  void serve() { farm_->serve(); }

 private:
  [[nodiscard]] FoundOnce find_here(const Repetition& repetition) const;

  const Experiment& experiment_;
  std::span<const ExperimentStep> steps_;
  sim::Farm::Work work_;
  std::optional<sim::Farm> farm_;
};

}  // namespace detp::validate
