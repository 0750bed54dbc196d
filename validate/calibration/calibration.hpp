#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "detp/model/vocabulary/vocabulary.hpp"

/// A calibration: the unit costs of a machine, how far they can be trusted, and to which machine and program they belong.
namespace detp::validate {

/// What measured costs, and choices made with them, depend on. They are only used where all of this is the same.
struct CalibrationKey {
  std::string cpu;              ///< model name
  std::string instruction_set;  ///< of the float kernels
  std::string caches;           ///< bytes of the levels 1 to 3
  int threads = 0;              ///< that the machine runs at once
  std::string compiler;
  int cost_model = 0;  ///< version of the terms that are fitted

  bool operator==(const CalibrationKey&) const = default;
};

/// The key of this program on this machine.
[[nodiscard]] CalibrationKey this_machine();

/// The first difference in words, as "its cpu is A, here it is B"; empty if the keys are equal.
[[nodiscard]] std::string difference(const CalibrationKey& stored, const CalibrationKey& here);

[[nodiscard]] nlohmann::ordered_json to_json(const CalibrationKey& key);

/// Throws nlohmann::json::exception if a value is missing or of another type.
[[nodiscard]] CalibrationKey key_of(const nlohmann::ordered_json& json);

/// A calibration whose median error on left-out workloads exceeds this is doubtful.
inline constexpr double doubtful_error = 0.15;
/// A calibration that got less than this share of the processor is doubtful: other programs also took caches and memory.
inline constexpr double doubtful_share = 0.9;

/// How far the costs of a calibration can be trusted.
struct CalibrationQuality {
  double left_out_median_error = 0;  ///< of all runs on one thread, by fits to other workloads
  double processor_share = 1;        ///< processor time over wall time of these runs; other programs took the rest
  /// built-in costs, scaled by a few short searches (calibration_file.hpp); never doubtful, because it promises little
  bool probe = false;

  /// Why predictions by these costs are doubtful, in words; empty if they are not.
  [[nodiscard]] std::string doubt() const;

  /// Standard error of seconds that these costs give for right counts, relative to the seconds: that of a normal
  /// distribution with this median error. At least the share of the time that other programs took.
  [[nodiscard]] double relative_error() const;

  /// A calibration is better than a probe, and one without doubt than a doubtful one; else the one with the smaller relative error.
  [[nodiscard]] bool is_better_than(const CalibrationQuality& other) const;
};

/// The costs of both engines. Of a calibration that was read, also to what it belongs.
struct Calibration : CalibrationQuality {
  CostTable plain;
  CostTable simd;
  CalibrationKey key = {};
  std::string date = {};  ///< "2026-11-20"

  [[nodiscard]] CostTable& of(Engine engine) { return engine == Engine::plain ? plain : simd; }
  [[nodiscard]] const CostTable& of(Engine engine) const { return engine == Engine::plain ? plain : simd; }
};

}  // namespace detp::validate
