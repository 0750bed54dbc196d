#include "detp/validate/structural/structural.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "detp/model/rank/predict.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/validate/statistics/statistics.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

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

TEST_SUITE("statistical") {
  TEST_CASE("counted tests and copies equal the structural ones: cube, faces, flat box with cells outside S0") {
    constexpr int batches = 16;
    for (const auto& discs : {samples(sim::Body::cube, glm::dvec3{1}), samples(sim::Body::cube_faces, glm::dvec3{1}),
                              samples(sim::Body::cube, {1, 0.4, 0.05})}) {
      const sim::Ray ray{};
      const sim::Problem problem = sim::make_problem({&ray, 1}, discs);
      for (const Candidate& candidate : hierarchies()) {
        CAPTURE(name(candidate.technique));
        CAPTURE(describe(candidate));
        const Counts<double> expected = structural_counts(problem, 1, candidate);
        std::array<std::vector<double>, 3> counted;
        for (int batch = 0; batch < batches; ++batch) {
          const auto values = per_line(discs, candidate, batch);
          for (std::size_t term = 0; term < 3; ++term) counted[term].push_back(values[term]);
        }
        const std::array predicted{expected.cull_tests, expected.listed, expected.disc_tests};
        for (std::size_t term = 0; term < 3; ++term) {
          const Estimate observed = batch_means(counted[term]);
          CAPTURE(term);
          CAPTURE(observed.mean / predicted[term]);
          // |Student's t| with 15 degrees of freedom exceeds 5 only once in 6000 cases.
          CHECK(std::abs(observed.mean - predicted[term]) <= 5 * observed.standard_error);
          CHECK_MESSAGE(std::abs(observed.mean - 1.05 * predicted[term]) > 5 * observed.standard_error,
                        "a formula wrong by 5 % must be refuted");
        }
      }
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
