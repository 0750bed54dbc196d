#pragma once

#include <optional>
#include <string>
#include <vector>

#include "detp/validate/accuracy/accuracy_check.hpp"
#include "detp/validate/accuracy/reference_file.hpp"
#include "detp/validate/axes/axes.hpp"
#include "detp/validate/checkpoint/checkpoint_file.hpp"
#include "detp/validate/cli/command.hpp"
#include "detp/validate/whole/whole.hpp"

/// The answer of `detp accuracy`, and what it has found so far, in a checkpoint.
namespace detp::cli {

struct AccuracyAnswer {
  std::string scene;    ///< as the user wrote it
  double side = 1;      ///< longest side of the scene's box
  std::string options;  ///< that `detp run` needs to repeat a point, as " --light sun"
  validate::AccuracyPilot pilot;
  validate::AccuracyPlan plan;
  std::optional<validate::Reference> reference;  ///< that the user asked for
  std::optional<validate::AccuracyCheck> check;
  validate::AccuracyPoint checked;  ///< what was run to check
  std::string no_check;             ///< why the answer was not run
  std::vector<validate::AccuracyRerun> reruns;
  std::vector<validate::AxisPoint> axes;  ///< other than estimators
  validate::AccuracyPoint in_time;        ///< the best way in twice the answer's time
  double seconds = 0;                     ///< that the pilots and the check took
  double most_rays = 1e9;                 ///< of --rays
  int threads = 1;                        ///< that a run uses
  sim::PolygonCounts polygons = {};       ///< of the scene's mesh
  std::uint64_t normals_made = 0;
  std::uint64_t coincident = 0;
  std::vector<std::string> warnings = {};  ///< that were noted
  validate::WholeInputs whole = {};        ///< of `detp run` with the answer
};

/// "detp run @cornell --rays 3.4e5 --estimator disc --disc-radius 0.021".
[[nodiscard]] std::string command_of(const AccuracyAnswer& answer, const validate::AccuracyPoint& point);

/// "d = 2.1 %", "k = 50"; empty if the estimator has no setting.
[[nodiscard]] std::string setting_words(const AccuracyAnswer& answer, const validate::AccuracyPoint& point);

/// The answer in sentences, with its command.
[[nodiscard]] std::string answer_words(const AccuracyAnswer& answer);

/// It has backward paths instead of photons.
[[nodiscard]] inline bool gathers(const validate::AccuracyPoint& point) {
  return point.estimator == sim::Estimator::gather;
}

/// The error for which AccuracyCheck::share_within counts samples: the target's, else 5 %.
[[nodiscard]] inline double within_of(const validate::AccuracyTarget& target) {
  return target.kind == validate::AccuracyTarget::Kind::seconds ? 0.05 : target.value;
}

/// 15 of 24 first runs took within this factor of the predicted seconds (validate/accuracy/README.md).
inline constexpr double seconds_factor = 1.5;

/// How many of the reruns have a noise in the answer's interval.
[[nodiscard]] std::size_t inside(const AccuracyAnswer& answer);

[[nodiscard]] Json to_json(const AccuracyAnswer& answer);
[[nodiscard]] std::string csv_of(const AccuracyAnswer& answer);
[[nodiscard]] std::string to_text(const AccuracyAnswer& answer, const Screen& screen);

struct SavedAccuracy {
  std::optional<validate::AccuracyPilot> pilot = {};
  std::optional<validate::AccuracyCheck> check = {};
  double planning_seconds = 0;  ///< of pilots and check
  std::vector<validate::MadeRerun> runs = {};
};

/// Nothing is saved if there is no file. Throws as CheckpointFile::read.
[[nodiscard]] SavedAccuracy read_accuracy(const validate::CheckpointFile& file, const std::stop_token& stop);

/// Throws as CheckpointFile::write.
void write_accuracy(validate::CheckpointFile& file, const SavedAccuracy& saved);

}  // namespace detp::cli
