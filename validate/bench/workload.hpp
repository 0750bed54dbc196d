#pragma once

#include <optional>
#include <string>
#include <vector>

#include "detp/validate/choice/job.hpp"

/// Which work the benchmark is about.
namespace detp::validate {

/// One piece of work: so many rays of a field against so many discs on a scene.
struct BenchWorkload {
  std::string scene;  ///< as shown: "@tree", "stanford_bunny"
  std::string path;   ///< as opened
  sim::Field field = sim::Field::isotropic;
  std::optional<double> samples;  ///< default: the scene's vertices
  Length disc_radius;
  double rays = 0;
};

/// Whether the two differ in nothing but the number of rays.
[[nodiscard]] bool same_but_rays(const BenchWorkload& a, const BenchWorkload& b);

/// The lists whose every combination is run; empty ones are filled in by the effort.
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
  std::vector<BenchWorkload> workloads;  ///< those that differ in the number of rays alone follow each other, rising
  std::vector<std::string> missing;      ///< why, for each that was left out
};

/// The set of that effort, narrowed to the axes given. `folder` holds the meshes; empty if nobody knows where they are.
///
/// quick      @uniform, @tree, @courtyard, @cornell, bunny; radii of 1 and 4 %; 10³ and 10⁵ rays
/// thorough   the same and seven more meshes; 0.5 … 16 %; 10³ … 10⁶ rays, the most of them at 0.5 and 2 % only;
///            @uniform with 10³, 10⁵ and 10⁶ samples
///
/// Fields: isotropic lines, and photon paths where there is a light (@uniform has none). A scene that is named alone is
/// run on the effort's other lists.
[[nodiscard]] BenchSet bench_set(BenchEffort effort, const BenchAxes& axes, const std::string& folder);

}  // namespace detp::validate
