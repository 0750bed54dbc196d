#pragma once

#include <string>

namespace detp::validate {

/// A calibration whose median error on left-out workloads exceeds this is doubtful.
inline constexpr double doubtful_error = 0.15;
/// A calibration that got less than this share of the processor is doubtful: other programs also took caches and memory.
inline constexpr double doubtful_share = 0.9;

/// How far the costs of a calibration can be trusted.
struct CalibrationQuality {
  double left_out_median_error = 0;  ///< of all runs on one thread, by fits to other workloads
  double processor_share = 1;        ///< processor time over wall time of these runs; other programs took the rest
  bool probe =
      false;  ///< built-in costs, scaled by a few short searches (probe.hpp); never doubtful, because it promises little

  /// Why predictions by these costs are doubtful, in words; empty if they are not.
  [[nodiscard]] std::string doubt() const;

  /// Standard error of seconds that these costs give for right counts, relative to the seconds: that of a normal
  /// distribution with this median error. At least the share of the time that other programs took.
  [[nodiscard]] double relative_error() const;

  /// A calibration is better than a probe, and one without doubt than a doubtful one; else the one with the smaller relative error.
  [[nodiscard]] bool is_better_than(const CalibrationQuality& other) const;
};

}  // namespace detp::validate
