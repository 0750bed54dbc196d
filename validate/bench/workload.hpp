#pragma once

#include <optional>
#include <string>
#include <vector>

#include "detp/validate/job/job.hpp"

/// The workloads of the benchmark.
namespace detp::validate {

/// One workload: a number of rays of a field, and a number of discs on a scene.
struct BenchWorkload {
  std::string scene;  ///< name to show: "@tree", "stanford_bunny"
  std::string path;   ///< built-in name or file to open
  sim::Field field = sim::Field::isotropic;
  std::optional<double> samples;  ///< default: one for each vertex of the scene
  Length disc_radius;
  double rays = 0;
};

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

}  // namespace detp::validate
