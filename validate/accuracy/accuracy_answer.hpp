#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "accuracy_check.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/scene/selection.hpp"
#include "detp/validate/axes/axes.hpp"
#include "detp/validate/base/fields.hpp"
#include "detp/validate/whole/whole.hpp"

/// What accuracy costs in a scene, from the question to the answer: all that `detp accuracy` does.
namespace detp::validate {

/// How long planning may take, until the bias is known to a fifth of the target: 0.5 s; that or 0.3 times the answer; 20 s or 20 times the answer.
enum class PlanningEffort { quick, usual, thorough };
inline constexpr std::array<std::string_view, 3> planning_efforts{"quick", "default", "thorough"};
[[nodiscard]] constexpr std::string_view name(PlanningEffort effort) {
  return planning_efforts[static_cast<std::size_t>(effort)];
}

/// Where accuracy costs time: in an estimator, or as validate/axes says.
enum class AccuracyAxis { estimator, simulation, model, arithmetic };
inline constexpr std::array<std::string_view, 4> accuracy_axes{"estimator", "simulation", "model", "arithmetic"};
[[nodiscard]] constexpr std::string_view name(AccuracyAxis axis) {
  return accuracy_axes[static_cast<std::size_t>(axis)];
}

struct AccuracyRequest {
  sim::SceneRequest scene;            ///< with the seed of all that is random
  std::optional<double> crease = {};  ///< degrees, in place of the scene's
  AccuracyTarget target = {};
  double most_rays = 1e9;
  std::vector<sim::Estimator> estimators = {};  ///< none: all
  std::optional<std::string> discs = {};        ///< the file of the discs in question; none: the scene's samples
  std::optional<std::string> disc_radius = {};  ///< as parse_length; none: by the mesh, or by the discs
  sim::FaceNames faces = {};                    ///< on which the discs in question are; none: on all
  std::optional<std::string> reference = {};    ///< the file of what bias is judged by; it is made if there is none
  std::optional<RerunSeeds> seeds = {};         ///< with which the answer is run again
  std::vector<AccuracyAxis> axes = {};
  PlanningEffort effort = PlanningEffort::usual;
  bool check = false;  ///< run the answer once
  bool front_facing = false;
  std::optional<std::string> checkpoint = {};  ///< a file
  bool resume = false;
  int threads = 0;              ///< 0: all cores
  sim::Ranks* ranks = nullptr;  ///< that have the same request: rank 0 answers, and they share the reruns
  /// A command that repeats a point begins and ends so: "detp run @cornell", " --light sun".
  std::string command = {};
  std::string command_end = {};
};

struct AccuracyAnswer {
  AccuracyRequest request;
  double side = 1;                         ///< longest side of the scene's box
  std::size_t samples = 0;                 ///< of the scene, or discs of the file
  std::optional<double> disc_radius = {};  ///< around which radii were tried, if it was given
  AccuracyPilot pilot = {};
  AccuracyPlan plan = {};
  AccuracyPoint in_time = {};  ///< the best way in twice the answer's time
  std::optional<AccuracyCheck> check = {};
  std::string no_check = {};  ///< why the answer was not run
  std::vector<AccuracyRerun> reruns = {};
  std::vector<AxisPoint> axes = {};  ///< other than estimators
  double planning_seconds = 0;       ///< of the pilots and the check
  WholeSeconds whole = {};           ///< of `detp run` with the answer
  double peak_bytes = 0;
  sim::PolygonCounts polygons = {};  ///< of the scene's mesh
  std::uint64_t normals_made = 0;
  std::uint64_t coincident = 0;
  std::vector<std::string> warnings = {};
  std::optional<sim::Progress> stopped = {};  ///< how far it came, if a stop request ended it before all was done

  /// The error for which AccuracyCheck::share_within counts samples: the target's, else 5 %.
  [[nodiscard]] double within() const {
    return plan.target.kind == AccuracyTarget::Kind::seconds ? 0.05 : plan.target.value;
  }
  /// How many of the reruns have a noise in the answer's interval.
  [[nodiscard]] std::size_t inside() const;
};

/// 15 of 24 first runs took within this factor of the predicted seconds (README.md).
inline constexpr double seconds_factor = 1.5;

/// Opens the scene, takes the discs in question, makes the reference, pilots and a plan, runs the plan's answer to check, and again with other seeds, and
/// adds other axes; with a checkpoint, what it has of these is not made again. `note` is called with each notice and warning at once. Of ranks other than 0
/// the answer is empty. Throws std::invalid_argument for a request out of range and scenes without triangles, NoLight, sim::FileError, and sim::Stopped if
/// there is nothing to answer yet.
[[nodiscard]] AccuracyAnswer answer(const AccuracyRequest& request, const std::stop_token& stop = {},
                                    const sim::ReportPhase& progress = {},
                                    const std::function<void(const std::string&)>& note = {});

/// What was asked, with what was not set resolved.
[[nodiscard]] Json inputs_json(const AccuracyAnswer& answer);
[[nodiscard]] Json to_json(const AccuracyAnswer& answer);

/// The table has a row for the answer, each rival, each point of the curves, each run again, and each point of other axes.
[[nodiscard]] Columns accuracy_columns();
[[nodiscard]] std::vector<Json> accuracy_rows(const AccuracyAnswer& answer);

/// All fields of the JSON and of the table; those of a part have its name before theirs ("reference.kind").
[[nodiscard]] std::vector<FieldText> describe_accuracy();

/// "4.2 %".
[[nodiscard]] std::string percent(double share);

/// "9 % (8 to 10)", "at most 2 %", "none".
[[nodiscard]] std::string bias_words(const AccuracyPoint& point);

/// "d = 2.1 %", "k = 50"; empty if the estimator has no setting.
[[nodiscard]] std::string setting_words(const AccuracyAnswer& answer, const AccuracyPoint& point);

/// "340 000 photon paths with discs of radius 0.021 (2.1 % of the scene), estimator disc".
[[nodiscard]] std::string way_words(const AccuracyAnswer& answer, const AccuracyPoint& point);

/// "detp run @cornell --rays 3.4e5 --estimator disc --disc-radius 0.021".
[[nodiscard]] std::string command_of(const AccuracyAnswer& answer, const AccuracyPoint& point);

/// The answer in sentences.
[[nodiscard]] std::string answer_words(const AccuracyAnswer& answer);

/// "disc is best; nearest takes 2.4 times as long (bias at most 2 %)".
[[nodiscard]] std::string rivals_words(const AccuracyAnswer& answer);

/// "5 runs with seeds 3 to 7: noise 5 % (4.8 % to 5.2 %), inside the interval in 5; …". There must be some.
[[nodiscard]] std::string reruns_words(const AccuracyAnswer& answer);

/// "against 64 backward paths of each of 1000 samples (error 2 %)."
[[nodiscard]] std::string judge_words(const AccuracyAnswer& answer);

}  // namespace detp::validate
