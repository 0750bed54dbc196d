#include "detp/validate/structural/structural.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/job/job.hpp"
#include "detp/validate/structural/structural_parts.hpp"

using namespace detp;
using namespace detp::validate;
using doctest::Approx;

namespace {

const std::vector<Candidate>& candidates() {
  static const std::vector<Candidate> list{{Technique::brute_force, BruteForceParameters{}},
                                           {Technique::sphere_cache, SphereCacheParameters{0.65, 4}},
                                           {Technique::cell_spheres, CellSpheresParameters{4}},
                                           {Technique::sphere_tree, SphereTreeParameters{8, 4}},
                                           {Technique::octree, OctreeParameters{0}},
                                           {Technique::octree, OctreeParameters{4, Traversal::front_to_back}},
                                           {Technique::octree, OctreeParameters{6}},
                                           {Technique::grid, GridParameters{5}},
                                           {Technique::grid, GridParameters{40}},
                                           {Technique::bsp, BspParameters{}}};
  return list;
}

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
  TEST_CASE("counts that do not depend on the rays equal those of a run") {
    const auto discs = sim::uniform_discs(sim::Body::cube_faces, 2, 2000, 0.03, 3);
    const auto rays = sim::LineField(sim::enclosing_sphere(discs), 4).lines(0, 10);
    for (const Candidate& candidate : candidates()) {
      const Counts<double> counted = as_expected(sim::run(sim::make_problem(rays, discs), candidate).counts);
      const Counts<double> expected = structural_counts(discs, 10, candidate);
      CAPTURE(name(candidate.technique));
      CHECK(expected.references == counted.references);
      CHECK(expected.placements == counted.placements);
      if (candidate.technique == Technique::sphere_tree || candidate.technique == Technique::box_tree) continue;
      CHECK(expected.culls == counted.culls);
      CHECK(expected.visits == counted.visits);
      CHECK(expected.sorted == counted.sorted);
    }
  }

  TEST_CASE("every technique has counts, or the reason why there are none") {
    const auto discs = sim::uniform_discs(sim::Body::cube, 2, 100, 0.05, 3);
    for (const Technique technique : all_techniques) {
      CAPTURE(name(technique));
      try {
        const Counts<double> counts = structural_counts(discs, 100, default_candidate(technique));
        CHECK(counts.hits > 0);
      } catch (const std::invalid_argument& error) {
        CHECK(std::string(error.what()).find(" has no structural counts: it") != std::string::npos);
      }
    }
  }

  TEST_CASE("brute force tests every disc with every ray; a disc is hit by d²/(2 r0²) of them") {
    const auto discs = sim::uniform_discs(sim::Body::cube, 2, 500, 0.05, 3);
    const double outer = sim::enclosing_sphere(discs).radius;
    const Counts<double> counts = structural_counts(discs, 1e6, candidates().front());
    CHECK(counts.disc_tests == 5e8);
    CHECK(counts.hits == Approx(5e8 * 0.05 * 0.05 / (2 * outer * outer)).epsilon(1e-12));
    CHECK(structural_counts(discs, 1e6, candidates().front(), {}, true).hits == counts.hits / 2);
  }

  TEST_CASE("twice the rays: twice the tests, the same references") {
    const auto discs = sim::uniform_discs(sim::Body::cube, 2, 500, 0.05, 3);
    for (const Candidate& candidate : candidates()) {
      const Counts<double> once = structural_counts(discs, 1000, candidate);
      const Counts<double> twice = structural_counts(discs, 2000, candidate);
      CHECK(twice.disc_tests == Approx(2 * once.disc_tests).epsilon(1e-12));
      CHECK(twice.cull_tests == Approx(2 * once.cull_tests).epsilon(1e-12));
      CHECK(twice.references == once.references);
    }
  }

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

TEST_SUITE("bad input") {
  TEST_CASE("numbers out of range, and techniques without structural counts, are refused") {
    const auto discs = sim::uniform_discs(sim::Body::cube, 2, 10, 0.05, 3);
    const Candidate brute = candidates().front();
    CHECK_THROWS_AS((void)structural_counts(std::span<const sim::Disc>{}, 10, brute), std::invalid_argument);
    for (const double rays : {0.0, -1.0, 0.5, std::nan("")})
      CHECK_THROWS_AS((void)structural_counts(discs, rays, brute), std::invalid_argument);
    CHECK_THROWS_AS((void)structural_counts(discs, 10, {Technique::octree, OctreeParameters{-1}}),
                    std::invalid_argument);
    CHECK_THROWS_AS((void)structural_counts(discs, 10, {Technique::sphere_cache_published, SphereCacheParameters{}}),
                    std::invalid_argument);
    CHECK_THROWS_AS(
        (void)structural_counts(discs, 10, {Technique::sphere_cache, SphereCacheParameters{0.5, 2, SampleOrder::none}}),
        std::invalid_argument);
    for (const Traversal traversal : {Traversal::restart, Traversal::neighbour_links})
      CHECK_THROWS_AS((void)structural_counts(discs, 10, {Technique::octree, OctreeParameters{3, traversal}}),
                      std::invalid_argument);
  }
}

TEST_SUITE("statistical") {
  // Seeds are fixed. 150 000 lines cause up to 1 % of noise, because a line meets many clustered discs or none.
  constexpr double rays = 150'000;

  void check_scene(const std::string& scene, double radius) {
    JobRequest request;
    request.scene = scene;
    request.rays = rays;
    request.samples = 5000;
    request.disc_radius = Length{radius, true};
    request.field = sim::Field::isotropic;
    const Job job = make_job(request);
    for (const Candidate& candidate : {Candidate{Technique::octree, OctreeParameters{6}},
                                       {Technique::grid, GridParameters{40}},
                                       {Technique::bsp, BspParameters{}}}) {
      const Counts<double> counted = as_expected(sim::run(job.problem(), candidate).counts);
      const Counts<double> expected = structural_counts(job.discs, rays, candidate);
      INFO("scene ", scene, ", name(candidate.technique) ", name(candidate.technique), ", describe(candidate) ",
           describe(candidate));
      const auto check = [](double of_structure, double of_run) {
        CAPTURE(of_structure / of_run);
        CHECK(std::abs(of_structure / of_run - 1) < 0.02);
        CHECK_MESSAGE(std::abs(1.04 * of_structure / of_run - 1) > 0.02, "4 % off must show");
      };
      CHECK(expected.references == counted.references);
      check(expected.disc_tests, counted.disc_tests);
      check(expected.hits, counted.hits);
      if (counted.nodes > 0) check(expected.nodes, counted.nodes);
      if (counted.steps > 0) check(expected.steps, counted.steps);
    }
  }

  TEST_CASE("the structural counts of an index agree with a search, in every built-in scene") {
    check_scene("@uniform", 0.02);
    check_scene("@tree", 0.02);
    check_scene("@courtyard", 0.02);
    check_scene("@cornell", 0.02);
  }

  TEST_CASE("the structural counts of the sphere cache agree with a run") {
    const auto discs = sim::uniform_discs(sim::Body::cube_faces, 2, 5000, 0.03, 3);
    const auto lines = sim::LineField(sim::enclosing_sphere(discs), 4).lines(0, 30'000);
    const Candidate candidate = candidates()[1];
    const Counts<double> counted = as_expected(sim::run(sim::make_problem(lines, discs), candidate).counts);
    const Counts<double> expected = structural_counts(discs, 30'000, candidate);
    CHECK(expected.cull_tests == Approx(counted.cull_tests).epsilon(0.02));
    CHECK(expected.disc_tests == Approx(counted.disc_tests).epsilon(0.02));
    CHECK(expected.listed == Approx(counted.listed).epsilon(0.02));
    CHECK(1.04 * expected.cull_tests != Approx(counted.cull_tests).epsilon(0.02));
  }

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
      INFO("ratio ", ratio, ", found.rebuild ", found.rebuild, ", found.intersect ", found.intersect);
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
        INFO("name ", name, ", ratio ", ratio, ", found.rebuild ", found.rebuild);
        CHECK(std::abs(found.rebuild - 1) < 0.02);
        CHECK_MESSAGE(std::abs(1.05 * found.rebuild - 1) > 0.02, "5 % off must show");
      }
    }
  }
}
