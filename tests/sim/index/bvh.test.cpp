#include <doctest/doctest.h>

#include <cmath>
#include <glm/exponential.hpp>
#include <numbers>
#include <vector>

#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

const Candidate brute{Technique::brute_force, BruteForceParameters{}};
const Candidate bvh{Technique::bvh, BvhParameters{}};

/// Rays aimed near the discs from the distance `far`: alternately segments that end near a disc, and lines.
std::vector<Ray> rays_from(const std::vector<Disc>& discs, double far) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < 4 * discs.size(); ++i) {
    const auto random = uniform4(31, Stream::tests, i);
    const Disc& disc = discs[i % discs.size()];
    const glm::dvec3 direction = uniform_direction(random[0], random[1]);
    const glm::dvec3 aside = glm::cross(direction, disc.normal);
    const glm::dvec3 aim = disc.centre + 1.5 * random[2] * disc.radius * aside;
    const double length = std::abs(far + (2 * random[3] - 1) * disc.radius);
    rays.push_back({.origin = aim - far * direction, .direction = direction});
    if (i % 2 == 0) rays.back().length = length;
  }
  return rays;
}

std::uint64_t check_agrees(const std::vector<Disc>& discs, double far) {
  const auto rays = rays_from(discs, far);
  const Problem problem = make_problem(rays, discs);
  const Outcome expected = run(problem, brute, {.pairs = true, .engine = Engine::plain});
  CHECK(run(problem, bvh, {.pairs = true}).pairs == expected.pairs);
  return expected.total_hits;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("single precision loses no hit, at any size of the scene and any distance of the rays") {
    for (const double size : {1e-90, 1e-9, 1.0, 1e9, 1e75})
      for (const double far : {1e-3, 1.0, 1e6, 1e9, 1e13}) {
        CAPTURE(size);
        CAPTURE(far);
        auto discs = uniform_discs(Body::cube, 2, 100, 0.1, 5);
        for (Disc& disc : discs) disc.centre *= size, disc.radius *= size;
        CHECK(check_agrees(discs, far * size) > (far > 1e12 ? 10 : 150));
      }
  }

  TEST_CASE("… and discs far smaller than its rounding error are found beside large ones") {
    auto discs = uniform_discs(Body::cube, 2, 150, 0.1, 5);
    for (std::size_t i = 0; i < discs.size(); i += 2) discs[i].radius = 1e-9;
    CHECK(check_agrees(discs, 1) > 150);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("a test is a disc whose box the ray meets, a reference is a disc") {
    const std::vector<Disc> discs{{{0, 0, 0}, {0, 0, 1}, 1}, {{10, 0, 0}, {0, 0, 1}, 1}};
    const std::vector<Ray> rays{{.origin = {0, 0, -3}},
                                {.origin = {10.95, 0.95, 0}},  // in the corner of the box, next to the disc
                                {.origin = {0, 1.01, 0}},
                                {.origin = {0, 0, 5}, .length = 4.99}};
    const Outcome outcome = run(make_problem(rays, discs), {Technique::bvh, BvhParameters{BuildQuality::medium}});
    CHECK(outcome.counts ==
          Counts<std::uint64_t>{
              .loaded = 4, .segments = 4, .disc_tests = 2, .references = 2, .placements = 2, .hits = 1});
  }

  TEST_CASE("isotropic lines: the number of tests follows from the areas of the boxes") {
    const auto discs = uniform_discs(Body::cube, 2, 2000, 0.05, 5);
    const auto rays = LineField(enclosing_sphere(discs), 6).lines(0, 20'000);
    // The number of lines that hit a convex body is proportional to its surface area. For a disc of radius d it is
    // 2π d², and for the disc's box
    //
    //     8 d² Σ √((1 - a²)(1 - b²))
    //
    // where the sum is over the pairs a, b of the normal's coordinates.
    double discs_area = 0;
    double boxes_area = 0;
    for (const auto& [centre, n, d] : discs) {
      const glm::dvec3 half = d * glm::sqrt(glm::dvec3{1.0} - n * n);
      boxes_area += 8 * (half.x * half.y + half.y * half.z + half.z * half.x);
      discs_area += 2 * std::numbers::pi * d * d;
    }
    const auto counts = run(make_problem(rays, discs), bvh).counts;
    CHECK(counts.hits > 10'000);
    const double counted = static_cast<double>(counts.disc_tests) / static_cast<double>(counts.hits);
    CHECK(counted == doctest::Approx(boxes_area / discs_area).epsilon(0.03));
  }
}
