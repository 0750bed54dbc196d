#pragma once

#include <optional>
#include <string>
#include <vector>

#include "workload.hpp"

/// The workloads of the benchmark, and those on which choices are judged.
namespace detp::validate {

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
