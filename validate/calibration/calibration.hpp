#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "cost_fit.hpp"

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

/// The costs of one engine. Fits are in the order of Technique; empty for techniques that are not exact, for those with
/// too few runs and, of the plain engine, for those whose engines are the same.
struct EngineCalibration {
  CostTable costs;  ///< the fitted ones; the built-in ones of techniques without a fit
  std::array<std::optional<CostFit>, all_techniques.size()> fits = {};
  std::array<std::optional<ThreadFit>, all_techniques.size()> thread_fits = {};
};

struct Calibration : CalibrationQuality {
  EngineCalibration plain = {};
  EngineCalibration simd = {};
  double threads_left_out_median_error = 0;  ///< of all runs on more threads, from their times on one; 0 without any
  std::size_t workloads = 0;                 ///< measured
  double seconds = 0;                        ///< that the calibration took
  bool stopped = false;  ///< a stop request came: the costs are fitted to the workloads measured until then

  [[nodiscard]] EngineCalibration& of(Engine engine) { return engine == Engine::plain ? plain : simd; }
  [[nodiscard]] const EngineCalibration& of(Engine engine) const { return engine == Engine::plain ? plain : simd; }
};

}  // namespace detp::validate
