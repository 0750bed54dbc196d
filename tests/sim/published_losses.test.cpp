#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <map>

#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

/// Share of the hits that the published walk loses, by Q: 100 000 lines and discs of radius 0.01 in a cube of side 2.
std::map<double, double> losses(Body body) {
  constexpr double radius = 0.01;
  const auto discs = uniform_discs(body, 2, 100'000, radius, 1);
  const Sphere outer = enclosing_sphere(discs);
  const auto rays = LineField(outer, 2).lines(0, 100'000);
  const Problem problem = make_problem(rays, discs);
  const auto all = run(problem, {Technique::box_tree, BoxTreeParameters{8, 8}}).total_hits;
  std::map<double, double> lost;
  for (const double ratio : {0.5, 0.6, 0.65, 0.8}) {
    const auto spheres = static_cast<std::int64_t>(std::ceil(std::log(radius / outer.radius) / std::log(ratio)));
    const Candidate published{Technique::sphere_cache_published, SphereCacheParameters{ratio, spheres}};
    const auto found = run(problem, published, {.count = false}).total_hits;
    lost[ratio] = 1 - static_cast<double>(found) / static_cast<double>(all);
    MESSAGE(fmt::format("{} Q {:.2f}, k {}: {} of {} hits lost, {:.1f} %", body == Body::cube ? "volume " : "surface",
                        ratio, spheres, all - found, all, 100 * lost[ratio]));
  }
  return lost;
}

}  // namespace

TEST_SUITE("statistical") {
  // A share of 165 000 hits has a standard deviation of at most 0.12 %. The tolerance, 1 %, is eight of these.
  TEST_CASE("the published walk loses a tenth of all hits at Q = 0.6 and over two fifths at 0.8, on surfaces more") {
    const std::map<double, double> volume = losses(Body::cube);
    const std::map<double, double> surface = losses(Body::cube_faces);
    CHECK(std::abs(volume.at(0.6) - 0.10) < 0.01);
    CHECK(std::abs(volume.at(0.8) - 0.43) < 0.01);
    CHECK(std::abs(surface.at(0.6) - 0.17) < 0.01);
    CHECK(std::abs(surface.at(0.8) - 0.49) < 0.01);
    for (const auto& [ratio, lost] : volume) CHECK(surface.at(ratio) > lost);
    for (const auto* lost : {&volume, &surface})  // losses grow with Q
      for (auto at = std::next(lost->begin()); at != lost->end(); ++at) CHECK(at->second > std::prev(at)->second);
  }
}
