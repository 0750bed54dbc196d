#include "detp/validate/structural/structural_parts.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"

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
  return {validate::structural_walk(discs, problem.enclosing(), parameters),
          sim::run(problem, {Technique::sphere_cache, parameters})};
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("rebuilds computed without rays are those of a run, sphere by sphere") {
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
  /// Structural / counted T_R and T_I, averaged over several sets of lines, since one set causes noise in both.
  struct Agreement {
    double rebuild = 0;
    double intersect = 0;
  };

  Agreement agreement(const std::vector<sim::Disc>& discs, double ratio, std::size_t lines, int sets) {
    const SphereCacheParameters parameters{ratio, 100};
    const sim::Sphere enclosing = sim::enclosing_sphere(discs);
    double cull_tests = 0;
    double disc_tests = 0;
    for (int set = 0; set < sets; ++set) {
      const auto rays = sim::LineField(enclosing, 4 + static_cast<std::uint64_t>(set)).lines(0, lines);
      const auto counts = sim::run(sim::make_problem(rays, discs), {Technique::sphere_cache, parameters}).counts;
      cull_tests += static_cast<double>(counts.cull_tests);
      disc_tests += static_cast<double>(counts.disc_tests);
    }
    const validate::ExpectedWalk expected = validate::structural_walk(discs, enclosing, parameters);
    const double all = static_cast<double>(lines) * sets;
    return {expected.cull_tests * all / cull_tests, expected.disc_tests * all / disc_tests};
  }

  // Seeds are fixed. 4 × 40 000 lines cause 0.2 % of noise in T_R and 0.4 % in T_I (standard errors over 6 sets).
  void check(sim::Body body) {
    const auto discs = sim::uniform_discs(body, 2, 5000, 0.02, 3);
    for (const double ratio : {0.3, 0.5, 0.65, 0.8, 0.9}) {
      const Agreement found = agreement(discs, ratio, 40'000, 4);
      CAPTURE(ratio);
      CAPTURE(found.rebuild);
      CAPTURE(found.intersect);
      CHECK(std::abs(found.rebuild - 1) < 0.01);
      CHECK(std::abs(found.intersect - 1) < 0.01);
      CHECK_MESSAGE(std::abs(1.02 * found.rebuild - 1) > 0.01, "2 % off must show");
    }
  }

  TEST_CASE("structural sphere and disc tests are within 1 % of the counts, in a volume and on faces") {
    check(sim::Body::cube);
    check(sim::Body::cube_faces);
  }

  // 8 × 5000 lines cause about 1 % of noise, because few of the lines through S0 come near the tree's samples.
  TEST_CASE("structural sphere tests are within 2 % of the counts in two scenes, a tree and a box") {
    for (const std::string name : {"@tree", "@cornell"}) {
      const sim::Scene scene = sim::open_scene({name, 5000, 1});
      const double radius = 0.01 * glm::length(scene.box.size());
      std::vector<sim::Disc> discs;
      for (const sim::Sample& sample : scene.samples) discs.push_back({sample.position, sample.normal, radius});
      for (const double ratio : {0.5, 0.8}) {
        const Agreement found = agreement(discs, ratio, 5000, 8);
        CAPTURE(name);
        CAPTURE(ratio);
        CAPTURE(found.rebuild);
        CHECK(std::abs(found.rebuild - 1) < 0.02);
        CHECK_MESSAGE(std::abs(1.05 * found.rebuild - 1) > 0.02, "5 % off must show");
      }
    }
  }
}
