#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "detp/validate/statistics/statistics.hpp"

namespace detp::study {

/// Ratios of predicted and counted values, for a line of a summary.
class Ratios {
 public:
  void add(double predicted, double counted) {
    if (predicted > 0 && counted > 0) off_.push_back(std::max(predicted / counted, counted / predicted));
  }
  /// "| what | number | median | worst | share within 25 % | share within a factor of 2 |".
  [[nodiscard]] std::string row(const std::string& what) const {
    if (off_.empty()) return fmt::format("| {} | 0 | | | | |\n", what);
    return fmt::format("| {} | {} | {:.3f} | {:.2f} | {:.0f} % | {:.0f} % |\n", what, off_.size(),
                       validate::median(off_), *std::max_element(off_.begin(), off_.end()), 100 * within(1.25),
                       100 * within(2));
  }
  /// "median, worst".
  [[nodiscard]] std::string text() const {
    if (off_.empty()) return "";
    return fmt::format("{:.3f}, {:.2f}", validate::median(off_), *std::max_element(off_.begin(), off_.end()));
  }

 private:
  [[nodiscard]] double within(double factor) const {
    const auto count = std::count_if(off_.begin(), off_.end(), [factor](double off) { return off <= factor; });
    return static_cast<double>(count) / static_cast<double>(off_.size());
  }

  std::vector<double> off_;  ///< the ratio or its inverse, whichever is at least 1
};

}  // namespace detp::study
