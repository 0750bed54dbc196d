#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/scene/built_in/mesh_pieces.hpp"
#include "detp/sim/search/irradiance.hpp"
#include "detp/sim/search/outcome.hpp"
#include "detp/sim/technique/technique.hpp"

using namespace detp;
using namespace detp::sim;

// Standard errors of photon paths against the spread of the irradiance over seeds.

namespace {

constexpr int path_seeds = 40;

struct FoundErrors {
  double low_ratio = 0;  ///< below it are a tenth of the ratios
  double ratio = 0;      ///< reported over found standard error, median over discs with an error in all runs
  double covered = 0;    ///< share of intervals ± 1.96 standard errors that hold the mean of the other runs
  std::size_t discs = 0;
};

/// Some 400 of the scene's vertices. (Most of @caustic's are on its glass ball.)
std::vector<Disc> discs_of_scene(const Scene& scene, double share) {
  const std::size_t step = scene.samples.size() / 400;
  std::vector<Disc> discs;
  for (std::size_t i = 0; i < scene.samples.size(); i += step)
    discs.push_back({scene.samples[i].position, scene.samples[i].normal, share * scene.box.longest_side()});
  return discs;
}

/// `whole`: rays have the numbers of their photons; otherwise each ray counts as a photon.
FoundErrors repeat_paths(const Scene& scene, double share, std::size_t rays, bool whole) {
  const std::vector<Disc> discs = discs_of_scene(scene, share);
  std::vector<Outcome> outcomes;
  for (int seed = 1; seed <= path_seeds; ++seed) {
    const Paths paths = photon_paths(scene, rays, static_cast<std::uint64_t>(seed));
    const Problem problem = whole ? make_problem(paths, discs) : make_problem(paths.rays, discs);
    outcomes.push_back(run(problem, {Technique::box_tree, BoxTreeParameters{}}, {.standard_error = true}));
  }
  FoundErrors found;
  std::vector<double> ratios;
  double intervals = 0;
  for (std::size_t d = 0; d < discs.size(); ++d) {
    if (std::ranges::any_of(outcomes, [d](const Outcome& one) {
          return is_weak({one.hits[d], one.irradiance[d], one.standard_error[d], one.upper_bound[d]});
        }))
      continue;
    double sum = 0;
    double reported = 0;
    for (const Outcome& one : outcomes) sum += one.irradiance[d];
    for (const Outcome& one : outcomes) reported += std::pow(one.standard_error[d], 2) / path_seeds;
    double spread = 0;
    for (const Outcome& one : outcomes) spread += std::pow(one.irradiance[d] - sum / path_seeds, 2) / (path_seeds - 1);
    ratios.push_back(std::sqrt(reported / spread));
    for (const Outcome& one : outcomes) {
      const double others = (sum - one.irradiance[d]) / (path_seeds - 1);
      const double error = std::sqrt(std::pow(one.standard_error[d], 2) + spread / (path_seeds - 1));
      found.covered += std::abs(one.irradiance[d] - others) <= 1.96 * error ? 1 : 0;
      ++intervals;
    }
  }
  found.discs = ratios.size();
  found.covered /= intervals;
  std::ranges::sort(ratios);
  found.low_ratio = ratios[ratios.size() / 10];
  found.ratio = ratios[ratios.size() / 2];
  return found;
}

}  // namespace

TEST_SUITE("statistical") {
  TEST_CASE("standard errors of photon paths are those found by repetition, in three scenes") {
    for (const char* name : {"@cornell", "@caustic", "@interior"}) {
      CAPTURE(name);
      const Scene scene = open_scene({.name = name, .samples = {}});
      const FoundErrors found = repeat_paths(scene, 0.04, 60'000, true);
      INFO("found.ratio ", found.ratio, ", found.covered ", found.covered);
      CHECK(found.discs > 60);
      // The ratio of a disc scatters by 11 % over 40 seeds; the median of 60 dependent discs by less than 5 %.
      CHECK(found.ratio > 0.9);
      CHECK(found.ratio < 1.1);
      CHECK(found.low_ratio > 0.8);
      CHECK(found.covered > 0.92);
    }
  }

  TEST_CASE("in a bright box photons come back to discs: pieces taken for independent have too small errors") {
    Scene scene;
    scene.name = "bright box";
    built_in::add_box(scene.mesh, glm::dvec3{-1.0}, {{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}}}, 0.25);
    for (const glm::dvec3& position : scene.mesh.positions) scene.box.include(position);
    scene.lights = {{PointLight{.position = {0.1, 0.2, 0.3}}}};
    scene.mesh.materials.all = {{.diffuse = 0.98}};
    for (int i = 0; i < 400; ++i) {
      const double along = -0.6 + 0.003 * i;
      scene.samples.push_back({{along, -1, 0.5 * along}, {0, 1, 0}});
    }
    const FoundErrors whole = repeat_paths(scene, 0.2, 60'000, true);
    const FoundErrors apart = repeat_paths(scene, 0.2, 60'000, false);
    INFO("whole.ratio ", whole.ratio, ", apart.ratio ", apart.ratio);
    CHECK(whole.ratio > 0.85);
    CHECK(whole.ratio < 1.15);
    CHECK(apart.ratio < 0.8);
    CHECK(apart.covered < 0.9);
  }
}
