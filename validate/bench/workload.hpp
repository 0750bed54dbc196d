#pragma once

#include <optional>
#include <string>
#include <vector>

#include "detp/validate/choice/job.hpp"

/// The workloads of the benchmark.
namespace detp::validate {

/// One workload: a number of rays of a field against a number of discs on a scene.
struct BenchWorkload {
  std::string scene;  ///< as shown: "@tree", "stanford_bunny"
  std::string path;   ///< as opened
  sim::Field field = sim::Field::isotropic;
  std::optional<double> samples;  ///< default: one for each vertex of the scene
  Length disc_radius;
  double rays = 0;
};

/// Whether the two workloads differ in the number of rays only.
[[nodiscard]] bool same_but_rays(const BenchWorkload& a, const BenchWorkload& b);

/// Lists of values; every combination is run. The effort fills in the empty lists.
struct BenchAxes {
  std::optional<std::string> scene;
  std::vector<sim::Field> fields;
  std::vector<double> samples;
  std::vector<Length> disc_radii;
  std::vector<double> rays;
};

enum class BenchEffort { quick, thorough };

/// Workloads to run, and those whose files are missing.
struct BenchSet {
  /// workloads that differ only in the number of rays are adjacent, in rising order
  std::vector<BenchWorkload> workloads;
  std::vector<std::string> missing;  ///< the reason for each workload that was left out
};

/// The workloads of that effort, restricted to the values in `axes`. `folder` holds the meshes; empty if unknown.
///
/// quick      @uniform, @tree, @courtyard, @cornell, bunny; radii of 1 and 4 %; 10³ and 10⁵ rays
/// thorough   the same and seven more meshes; 0.5 … 16 %; 10³ … 10⁶ rays, the largest number at 0.5 and 2 % only;
///            @uniform with 10³, 10⁵ and 10⁶ samples
///
/// Fields: isotropic lines, and photon paths if there is a light (@uniform has none). If `axes` names a single scene,
/// it is run with the effort's other lists.
[[nodiscard]] BenchSet bench_set(BenchEffort effort, const BenchAxes& axes, const std::string& folder);

}  // namespace detp::validate
