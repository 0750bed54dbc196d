#include "detp/validate/structural_walk.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "detp/sim/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/sim/uniform_discs.hpp"

using namespace detp;

namespace {

struct Walked {
  validate::ExpectedWalk expected;
  sim::Outcome counted;
};

Walked walk(sim::Body body, double ratio, std::size_t lines) {
  const auto discs = sim::uniform_discs(body, 2, 5000, 0.02, 3);
  const auto rays = sim::LineField(sim::enclosing_sphere(discs), 4).lines(0, lines);
  const sim::Problem problem = sim::make_problem(rays, discs);
  const SphereCacheParameters parameters{ratio, 100};
  return {validate::structural_walk(discs, problem.enclosing, parameters),
          sim::run(problem, {Technique::sphere_cache, parameters})};
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("rebuilds without rays are those of the technique, sphere by sphere") {
    for (const auto body : {sim::Body::cube, sim::Body::cube_faces})
      for (const double ratio : {0.3, 0.65, 0.9}) {
        const Walked walked = walk(body, ratio, 1);
        REQUIRE(walked.expected.spheres.size() == walked.counted.spheres.size());
        for (std::size_t i = 0; i < walked.counted.spheres.size(); ++i)
          CHECK(walked.expected.spheres[i].rebuilds == static_cast<double>(walked.counted.spheres[i].rebuilds));
      }
  }
}

TEST_SUITE("statistical") {
  // Seeds are fixed. 40 000 lines leave about 0.5 % of noise in T_R, 1 % in T_I.
  void check(sim::Body body) {
    for (const double ratio : {0.3, 0.5, 0.65, 0.8, 0.9}) {
      const Walked walked = walk(body, ratio, 40'000);
      const double sphere_tests = static_cast<double>(walked.counted.counts.sphere_tests) / 40'000;
      const double disc_tests = static_cast<double>(walked.counted.counts.disc_tests) / 40'000;
      CAPTURE(ratio);
      CAPTURE(walked.expected.sphere_tests / sphere_tests);
      CHECK(std::abs(walked.expected.sphere_tests / sphere_tests - 1) < 0.02);
      CHECK(std::abs(walked.expected.disc_tests / disc_tests - 1) < 0.03);
      CHECK_MESSAGE(std::abs(1.05 * walked.expected.sphere_tests / sphere_tests - 1) > 0.02, "5 % off must show");
    }
  }

  TEST_CASE("sphere tests within 2 %, disc tests within 3 %, in a volume and on faces") {
    check(sim::Body::cube);
    check(sim::Body::cube_faces);
  }
}
