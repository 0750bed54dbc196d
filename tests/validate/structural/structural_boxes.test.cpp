#include "detp/validate/structural/structural_parts.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "detp/model/hierarchy/box_tree.hpp"
#include "detp/model/rank/predict.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/validate/job/job.hpp"
#include "detp/validate/statistics/statistics.hpp"
#include "detp/validate/structural/structural.hpp"

using namespace detp;
using namespace detp::validate;
using doctest::Approx;

namespace {

using sim::stream::TreeNode;

TreeNode box_of(const std::array<float, 3>& centre, const std::array<float, 3>& half) {
  TreeNode node{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    node.centre[axis] = centre[axis];
    node.half[axis] = half[axis];
  }
  return node;
}

/// The cross-section of the lines listed for a box, averaged over directions by the midpoint rule, divided by the
/// cross-section of S₀.
double listed_by_quadrature(const std::array<float, 3>& half, double outer) {
  constexpr int steps = 600;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const double cosine = (i + 0.5) / steps;
      const double sine = std::sqrt(1 - cosine * cosine);
      const double angle = 2 * std::numbers::pi * (j + 0.5) / steps;
      const std::array<double, 3> direction{std::abs(sine * std::cos(angle)), std::abs(sine * std::sin(angle)), cosine};
      std::size_t z = 0;
      for (std::size_t axis = 1; axis < 3; ++axis)
        if (direction[axis] > direction[z]) z = axis;
      const std::size_t x = (z + 1) % 3;
      const std::size_t y = (z + 2) % 3;
      sum += 4 * (half[x] + direction[x] / direction[z] * half[z]) * (half[y] + direction[y] / direction[z] * half[z]) *
             direction[z];
    }
  return sum / (steps * steps) / (std::numbers::pi * outer * outer);
}

const std::vector<Candidate>& hierarchies() {
  static const std::vector<Candidate> list{{Technique::cell_spheres, CellSpheresParameters{3}},
                                           {Technique::cell_spheres, CellSpheresParameters{5}},
                                           {Technique::sphere_tree, SphereTreeParameters{8, 12}},
                                           {Technique::sphere_tree, SphereTreeParameters{3, 2}}};
  return list;
}

std::vector<sim::Disc> samples(sim::Body body, const glm::dvec3& shape) {
  auto discs = sim::uniform_discs(body, 2, 4000, 0.02, 21);
  for (sim::Disc& disc : discs) disc.centre *= shape;
  return discs;
}

std::array<double, 3> per_line(const std::vector<sim::Disc>& discs, const Candidate& candidate, int batch) {
  constexpr std::size_t lines = 4000;
  const auto rays =
      sim::LineField(sim::enclosing_sphere(discs), 77).lines(lines * static_cast<std::size_t>(batch), lines);
  const auto counts = as_expected(sim::run(sim::make_problem(rays, discs), candidate).counts);
  return {counts.cull_tests / lines, counts.listed / lines, counts.disc_tests / lines};
}

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("inside S0, P agrees with a sum over directions") {
    for (const std::array<float, 3> half :
         {std::array<float, 3>{0.1F, 0.1F, 0.1F}, {0.2F, 0.05F, 0.01F}, {0.1F, 0, 0}}) {
      const double ratio = BoxCrossing(0.7, 0)(box_of({0.1F, 0.2F, 0}, half)) / listed_by_quadrature(half, 0.7);
      CAPTURE(ratio);
      CHECK(std::abs(ratio - 1) < 1e-4);
      CHECK_MESSAGE(std::abs(1.001 * ratio - 1) > 1e-4, "0.1 % off must show");
    }
  }

  TEST_CASE("the plain engine lists the lines that cross a cube, the simd engine 9.2 % more") {
    const double crossing = 24 * 0.01 / (4 * std::numbers::pi);
    const TreeNode cube = box_of({0, 0, 0}, {0.1F, 0.1F, 0.1F});
    CHECK(BoxCrossing(1, 0, Engine::plain)(cube) / crossing == Approx(1).epsilon(1e-6));
    CHECK(BoxCrossing(1, 0, Engine::simd)(cube) / crossing == Approx(1.0916).epsilon(1e-4));
  }
}

TEST_SUITE("limit") {
  TEST_CASE("a box much larger than S0 is crossed by all lines, one outside by few; listed lines never exceed all") {
    CHECK(BoxCrossing(0.5, 0)(box_of({0, 0, 0}, {3, 3, 3})) == Approx(1).epsilon(0.02));
    CHECK(BoxCrossing(0.5, 0)(box_of({10, 0, 0}, {0.1F, 0.1F, 0.1F})) < 1e-3);
    const double inside = BoxCrossing(0.5, 0)(box_of({0, 0, 0}, {0.05F, 0.05F, 0.05F}));
    CHECK(BoxCrossing(0.5, 0)(box_of({0.45F, 0, 0}, {0.05F, 0.05F, 0.05F})) <= inside);
  }

  TEST_CASE("the discs of a single leaf are tested with every ray") {
    const auto discs = sim::uniform_discs(sim::Body::cube, 2, 10, 0.05, 3);
    const auto counts = structural_counts(discs, 100, {Technique::box_tree, BoxTreeParameters{4, 16}});
    CHECK(counts.disc_tests == 1000);
    CHECK(counts.cull_tests == 0);
    CHECK(counts.culls == 0);
  }
}

TEST_SUITE("statistical") {
  // Seeds are fixed. 150 000 lines cause up to 1 % of noise, because a line meets many clustered discs or none.
  constexpr double rays = 150'000;

  TEST_CASE("the structural counts of the box tree agree with a search, in every built-in scene") {
    for (const char* scene : {"@uniform", "@tree", "@courtyard", "@cornell"}) {
      JobRequest request;
      request.scene = scene;
      request.rays = rays;
      request.samples = 5000;
      request.disc_radius = Length{0.01, true};
      request.field = sim::Field::isotropic;
      const Job job = make_job(request);
      for (const auto& tree : {std::pair{BoxTreeParameters{4, 16}, Engine::simd},
                               {BoxTreeParameters{8, 4}, Engine::simd},
                               {BoxTreeParameters{8, 4}, Engine::plain}}) {
        const Candidate candidate{Technique::box_tree, tree.first};
        const Engine engine = tree.second;
        const Counts<double> counted = as_expected(sim::run(job.problem(), candidate, {.engine = engine}).counts);
        const Counts<double> expected = structural_counts(job.discs, rays, candidate, {}, false, engine);
        CAPTURE(scene);
        INFO(name(engine), " engine, ", describe(candidate));
        for (const auto term : {&Counts<double>::cull_tests, &Counts<double>::listed, &Counts<double>::disc_tests,
                                &Counts<double>::culls, &Counts<double>::visits}) {
          CAPTURE(expected.*term / counted.*term);
          CHECK(std::abs(expected.*term / counted.*term - 1) < 0.015);
          CHECK_MESSAGE(std::abs(1.03 * expected.*term / counted.*term - 1) > 0.015, "3 % off must show");
        }
      }
    }
  }

  TEST_CASE("counted tests and copies equal the structural ones: cube, faces, flat box with cells outside S0") {
    constexpr int batches = 16;
    for (const auto& discs : {samples(sim::Body::cube, glm::dvec3{1}), samples(sim::Body::cube_faces, glm::dvec3{1}),
                              samples(sim::Body::cube, {1, 0.4, 0.05})}) {
      const sim::Ray ray{};
      const sim::Problem problem = sim::make_problem({&ray, 1}, discs);
      for (const Candidate& candidate : hierarchies()) {
        INFO("name(candidate.technique) ", name(candidate.technique), ", describe(candidate) ", describe(candidate));
        const Counts<double> expected = structural_counts(problem, 1, candidate);
        std::array<std::vector<double>, 3> counted;
        for (int batch = 0; batch < batches; ++batch) {
          const auto values = per_line(discs, candidate, batch);
          for (std::size_t term = 0; term < 3; ++term) counted[term].push_back(values[term]);
        }
        const std::array predicted{expected.cull_tests, expected.listed, expected.disc_tests};
        for (std::size_t term = 0; term < 3; ++term) {
          const Estimate observed = batch_means(counted[term]);
          INFO("term ", term, ", observed.mean / predicted[term] ", observed.mean / predicted[term]);
          // |Student's t| with 15 degrees of freedom exceeds 5 only once in 6000 cases.
          CHECK(std::abs(observed.mean - predicted[term]) <= 5 * observed.standard_error);
          CHECK_MESSAGE(std::abs(observed.mean - 1.05 * predicted[term]) > 5 * observed.standard_error,
                        "a formula wrong by 5 % must be refuted");
        }
      }
    }
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("the closed form agrees with counts on random samples, for any fan-out and leaf") {
    // For leaves of at least two discs, the largest deviations of the four counts checked below are 8, 8, 12 and 10 %
    // over 400 trees (validate/tools/box_tree_accuracy.cpp).
    constexpr std::array trees{BoxTreeParameters{2, 3}, BoxTreeParameters{3, 150}, BoxTreeParameters{4, 16},
                               BoxTreeParameters{7, 2}, BoxTreeParameters{11, 40}, BoxTreeParameters{16, 8}};
    constexpr double samples = 6000;
    constexpr double rays = 30000;
    for (const int dimension : {2, 3})
      for (const double radius : {1e-4, 0.005, 0.03, 0.1}) {
        const auto body = dimension == 3 ? sim::Body::cube : sim::Body::cube_faces;
        const auto discs = sim::uniform_discs(body, 1, static_cast<std::size_t>(samples), radius, 271828);
        for (const BoxTreeParameters& tree : trees) {
          const Candidate candidate{Technique::box_tree, tree};
          const auto expected = model::predict(cube_workload(rays, samples, radius, 1, dimension), candidate);
          const auto counted = structural_counts(discs, rays, candidate);
          INFO("dimension ", dimension, ", radius ", radius, ", tree.fan_out ", tree.fan_out, ", tree.leaf ",
               tree.leaf);
          CHECK(expected.cull_tests == Approx(counted.cull_tests).epsilon(0.1));
          CHECK(expected.listed == Approx(counted.listed).epsilon(0.1));
          CHECK(expected.disc_tests == Approx(counted.disc_tests).epsilon(0.12));
          CHECK(expected.culls == Approx(counted.culls).epsilon(0.15));
        }
      }
  }
}

TEST_SUITE("identity") {
  TEST_CASE("in a cube the cells' closed form is the structural one, except for cells that are empty by chance") {
    const auto discs = samples(sim::Body::cube, glm::dvec3{1});
    const sim::Ray ray{};
    const sim::Problem problem = sim::make_problem({&ray, 1}, discs);
    Workload workload = cube_workload(1000, 4000, 0.02, 2);
    workload.sphere_radius = problem.enclosing().radius;
    const Candidate candidate{Technique::cell_spheres, CellSpheresParameters{2}};  // none of 64 cells is empty
    const Counts<double> structural = structural_counts(problem, 1000, candidate);
    const Counts<double> closed = model::predict(workload, candidate);
    CHECK(structural.culls == 8 + 64);
    CHECK(closed.culls == doctest::Approx(8 + 64).epsilon(1e-9));
    CHECK(structural.cull_tests == doctest::Approx(closed.cull_tests).epsilon(2e-3));
    CHECK(structural.disc_tests == doctest::Approx(closed.disc_tests).epsilon(2e-3));
  }

  TEST_CASE("counts that need no ray equal those of a run: cells with spheres, and sorted samples") {
    const auto discs = samples(sim::Body::cube_faces, glm::dvec3{1});
    const sim::Ray ray{};
    const sim::Problem problem = sim::make_problem({&ray, 1}, discs);
    for (const Candidate& candidate : hierarchies()) {
      const auto counted = as_expected(sim::run(problem, candidate).counts);
      const Counts<double> expected = structural_counts(problem, 1, candidate);
      if (candidate.technique == Technique::cell_spheres) CHECK(expected.culls == counted.culls);
      CHECK(expected.sorted == counted.sorted);
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("parameters out of range are refused") {
    const auto discs = samples(sim::Body::cube, glm::dvec3{1});
    const sim::Ray ray{};
    const sim::Problem problem = sim::make_problem({&ray, 1}, discs);
    CHECK_THROWS_WITH_AS((void)structural_counts(problem, 1, {Technique::cell_spheres, CellSpheresParameters{17}}),
                         doctest::Contains("depth"), std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)structural_counts(problem, 0, hierarchies()[0]), doctest::Contains("rays"),
                         std::invalid_argument);
  }
}
