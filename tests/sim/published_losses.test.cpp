#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "detp/sim/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/sim/uniform_discs.hpp"

using namespace detp;
using namespace detp::sim;

TEST_SUITE("statistical") {
  TEST_CASE("the paper's walk loses a tenth of all hits at Q = 0.6 and over two fifths at 0.8; on surfaces more") {
    constexpr double radius = 0.01;
    for (const Body body : {Body::cube, Body::cube_faces}) {
      const auto discs = uniform_discs(body, 2, 100'000, radius, 1);
      const Sphere outer = enclosing_sphere(discs);
      const auto rays = LineField(outer, 2).lines(0, 100'000);
      const Problem problem = make_problem(rays, discs);
      const auto all = run(problem, {Technique::sphere_tree, SphereTreeParameters{8, 8, Bounds::boxes}}).total_hits;
      double before = 0;
      for (const double ratio : {0.5, 0.6, 0.65, 0.8}) {
        const auto spheres = static_cast<std::int64_t>(std::ceil(std::log(radius / outer.radius) / std::log(ratio)));
        const Candidate published{Technique::sphere_cache_published, SphereCacheParameters{ratio, spheres}};
        const auto found = run(problem, published, {.count = false}).total_hits;
        const double lost = 1 - static_cast<double>(found) / static_cast<double>(all);
        MESSAGE(fmt::format("{} Q {:.2f}, k {}: {} of {} hits lost, {:.1f} %",
                            body == Body::cube ? "volume " : "surface", ratio, spheres, all - found, all, 100 * lost));
        CHECK(lost > before);  // the nearer Q is to 1, the more
        before = lost;
      }
      CHECK(before > 0.3);
    }
  }
}
