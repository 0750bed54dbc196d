#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "detp/sim/base/phase.hpp"
#include "detp/sim/geometry/geometry.hpp"
#include "detp/validate/answer/parts.hpp"
#include "detp/validate/job/job.hpp"

/// The workloads of `detp bench`: of races, and those on which choices are judged.
namespace detp::validate {

enum class AwkwardScene {
  clusters,     ///< in 20 clusters of very different sizes in a cube
  tiny_object,  ///< half on a floor, half on a ball with a hundredth of the floor's side as diameter
  thin_sheet,   ///< in a plane
  strays,       ///< uniform in a cube, but five of them 300 times the cube's side away
  mixed_radii   ///< uniform in a cube, with log-normal radii: a factor of e is one standard deviation
};

/// "tiny-object".
[[nodiscard]] std::string_view name(AwkwardScene scene);

/// `count` discs with isotropic normals. `radius` is the (median) disc radius; the longest side of the cube, floor or
/// sheet is 1. Each disc is a function of the seed and of its number.
[[nodiscard]] std::vector<sim::Disc> awkward_discs(AwkwardScene scene, std::size_t count, double radius,
                                                   std::uint64_t seed);

/// A number of rays of a field, and a number of discs.
struct BenchWorkload {
  std::string scene;                              ///< name to show: "@tree", "sponza", "thin-sheet"
  std::variant<std::string, AwkwardScene> discs;  ///< a built-in scene or a file to open, or discs to make
  sim::Field field = sim::Field::isotropic;
  std::optional<double> samples = {};  ///< default: one for each vertex of the scene
  Length disc_radius = {};
  double rays = 0;
  bool held_out = false;  ///< its scene was not used to set any number of a chooser
  sim::EffectSelection effects = {};
};

/// "4%" of the scene's longest side, or "0.02".
[[nodiscard]] std::string radius_text(const BenchWorkload& workload);

/// "@tree, photons, 1000 rays, radius 4%".
[[nodiscard]] std::string title_of(const BenchWorkload& workload);

/// The rays and discs. Throws as make_job does.
[[nodiscard]] Job make_bench_job(const BenchWorkload& workload, std::uint64_t seed, const std::stop_token& stop = {},
                                 const sim::ReportPhase& progress = {});

/// Passes the phases on, each with the title before it: "TITLE: making rays".
[[nodiscard]] sim::ReportPhase titled(const sim::ReportPhase& progress, const std::string& title);

struct SkippedWorkload {
  BenchWorkload workload;
  std::string why;
};

/// How far the work on many workloads came.
struct SetProgress {
  std::vector<SkippedWorkload> skipped = {};
  std::size_t workloads = 0;  ///< number of requested workloads
  std::size_t done = 0;       ///< number of workloads run to the end or skipped
  bool stopped = false;       ///< a stop request came before the end
};

/// Works on the workload with this number. Returns why it is skipped; nothing if it was run to the end. Throws sim::Stopped if a stop
/// request ended it.
using RunWorkload = std::function<std::string(std::size_t place, const sim::ReportPhase& progress)>;

/// Works on one workload after the other. Expects that each takes a time roughly proportional to its rays.
[[nodiscard]] SetProgress run_each(std::span<const BenchWorkload> workloads, const RunWorkload& run,
                                   const std::stop_token& stop, const sim::ReportPhase& progress);

/// An array with `workload` and `why` of each that was skipped.
[[nodiscard]] Json skipped_json(const SetProgress& set);

/// True if the two workloads are equal, except perhaps in the number of rays.
[[nodiscard]] bool same_but_rays(const BenchWorkload& a, const BenchWorkload& b);

/// Lists of values, of which every combination is run. Empty lists stand for the values of the effort.
struct BenchAxes {
  std::optional<std::string> scene;
  std::vector<sim::Field> fields;
  std::vector<double> samples;
  std::vector<Length> disc_radii;
  std::vector<double> rays;
};

enum class BenchEffort { quick, thorough };

/// Workloads to run, and the meshes whose files are missing.
struct BenchSet {
  /// workloads that differ only in the number of rays are adjacent, in rising order
  std::vector<BenchWorkload> workloads;
  std::vector<std::string> missing;  ///< the name of each mesh that was left out, and why
};

/// The workloads of `effort`. Each list in `axes` that is not empty replaces the effort's values. `folder` holds the
/// meshes; empty if unknown.
///
/// quick      @uniform, @tree, @courtyard, @cornell, bunny; radii of 1 and 4 %; 10³ and 10⁵ rays
/// thorough   the same scenes and seven more meshes; radii of 0.5 … 16 %; 10³ … 10⁶ rays, but 10⁶ rays only with radii
///            of 0.5 and 2 %; @uniform with 10³, 10⁵ and 10⁶ samples
///
/// Fields: isotropic lines, and photon paths if the scene has a light (@uniform has none). If `axes` names a scene,
/// only that scene is run.
[[nodiscard]] BenchSet bench_set(BenchEffort effort, const BenchAxes& axes, const std::string& folder);

/// The workloads on which choices are judged, scene by scene, first those that are not held out. `folder` holds the meshes, all of which are held
/// out; empty if unknown. Every scene has the radii 0.25, 1, 4 and 16 % of its longest side; the numbers of rays, fields
/// and samples vary. Workloads with more than about 3·10⁷ hits are left out, and so are 10⁶ rays on large discs.
///
/// quick      workloads of 10³ and 10⁴ rays and at most 10⁴ discs; no meshes
/// thorough   all
[[nodiscard]] BenchSet regret_set(BenchEffort effort, const std::string& folder);

/// 84 workloads in 12 scenes, two of each family (sim/scene/families): photon paths and lines, radii from 0.25 to 16 % of the scene and 10² to 10⁶
/// rays, log-uniform at random; at most about 3·10⁷ hits. All are held out if nobody has looked at results of this seed.
[[nodiscard]] std::vector<BenchWorkload> family_workloads(std::uint64_t seed);

}  // namespace detp::validate
