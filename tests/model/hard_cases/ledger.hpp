#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "support/high_precision.hpp"

/// Records the errors of formulas.
namespace detp::hard_cases {

using support::Exact;

/// The largest error allowed for every formula.
inline constexpr double allowed = 1e-13;

/// One formula: the number of its inputs, and its largest error.
struct Entry {
  std::uint64_t inputs = 0;
  double worst = -1;  ///< relative error
  std::string where;  ///< inputs, expected and computed value of the largest error
};

/// Compares values with exact ones. `describe` returns the inputs as text; it is only called if the text is kept.
class Ledger {
 public:
  template <class Describe>
  void compare(const char* formula, double value, const Exact& exact, const Describe& describe) {
    record(formula, support::relative_error(value, exact), [&] {
      return fmt::format("{}: expected {}, got {:.17g}", describe(), exact.str(25, std::ios_base::scientific), value);
    });
  }

  /// Records a whole number, which is right (error 0) or wrong (error 1).
  template <class Describe>
  void compare_whole(const char* formula, std::int64_t value, bool right, const Describe& describe) {
    record(formula, right ? 0 : 1, [&] { return fmt::format("{}: got {}", describe(), value); });
  }

  void merge(const Ledger& other) {
    for (const auto& [formula, theirs] : other.entries_) {
      Entry& ours = entries_[formula];
      ours.inputs += theirs.inputs;
      if (theirs.worst > ours.worst) {
        ours.worst = theirs.worst;
        ours.where = theirs.where;
      }
    }
    failures_ += other.failures_;
    for (const std::string& text : other.shown_)
      if (shown_.size() < most_shown) shown_.push_back(text);
  }

  [[nodiscard]] const std::map<std::string, Entry>& entries() const { return entries_; }
  [[nodiscard]] std::uint64_t failures() const { return failures_; }

  /// The first failures in full.
  [[nodiscard]] std::string report() const {
    std::string text = fmt::format("{} values are off by more than {:g}", failures_, allowed);
    for (const std::string& failure : shown_) text += "\n  " + failure;
    return text;
  }

  /// One line for each formula: name, inputs, largest relative error, where.
  [[nodiscard]] std::string table() const {
    std::string text;
    for (const auto& [formula, entry] : entries_)
      text += fmt::format("{:<40} {:>9} {:>9.2g}  {}\n", formula, entry.inputs, entry.worst,
                          entry.worst > 0 ? "at " + entry.where : "");
    return text;
  }

 private:
  static constexpr std::size_t most_shown = 12;

  template <class Where>
  void record(const char* formula, double error, const Where& where) {
    Entry& entry = entries_[formula];
    ++entry.inputs;
    if (error > entry.worst) {
      entry.worst = error;
      entry.where = where();
    }
    if (error <= allowed) return;
    ++failures_;
    if (shown_.size() < most_shown) shown_.push_back(fmt::format("{} off by {:.3g} at {}", formula, error, where()));
  }

  std::map<std::string, Entry> entries_;
  std::uint64_t failures_ = 0;
  std::vector<std::string> shown_;
};

}  // namespace detp::hard_cases
