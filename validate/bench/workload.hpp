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

/// A workload of `detp bench`, and the course of work on many.
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

}  // namespace detp::validate
