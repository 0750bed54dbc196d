#include "detp/validate/choice/pilot.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "detp/model/lines/line_measure.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/effects/observe.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/choice/choice.hpp"

using namespace detp;
using doctest::Approx;

namespace {

/// Lines, or their pieces of this length that start at the line's point nearest to the centre.
struct FieldExample {
  FieldExample(std::size_t samples, double radius, std::size_t count, double length = 0)
      : discs(sim::uniform_discs(sim::Body::cube_faces, 2, samples, radius, 3)),
        rays(sim::LineField(sim::enclosing_sphere(discs), 4).lines(0, count)) {
    for (sim::Ray& ray : rays)
      if (length > 0) ray.length = length;
    problem = sim::make_problem(rays, discs);
    workload = sim::observe(*problem).workload;
  }

  [[nodiscard]] validate::Choice choose(validate::Question question = {}) const {
    return choose(sim::make_problem_without_rays(discs, 10), std::move(question));
  }
  [[nodiscard]] validate::Choice choose(const sim::Problem& searched, validate::Question question = {}) const {
    question.problem = &searched;
    question.workload = workload;
    question.rigor = Rigor::structural;
    return validate::choose(question, validate::built_in_unit_costs());
  }

  std::vector<sim::Disc> discs;
  std::vector<sim::Ray> rays;
  std::optional<sim::Problem> problem;
  Workload workload;
};

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("the rays of the run decide nothing: without them, the choice and its counts are the same") {
    const FieldExample example(5000, 0.02, 5000);
    sim::Problem problem = sim::make_problem_without_rays(example.discs, 10);
    sim::set_rays(problem, example.rays);
    const auto with_rays = example.choose(problem);
    const auto without = example.choose();
    REQUIRE(with_rays.candidates.size() == without.candidates.size());
    for (std::size_t i = 0; i < without.candidates.size(); ++i) {
      CHECK(with_rays.candidates[i].candidate == without.candidates[i].candidate);
      CHECK(with_rays.candidates[i].counts == without.candidates[i].counts);
    }
  }

  TEST_CASE("hits are not counted: their number is the expected one") {
    const FieldExample example(5000, 0.05, 5000);
    CHECK(example.choose().best().counts.hits == model::expected_hits(example.workload));
  }

  TEST_CASE("a run of fewer rays than the sample has an uncertain prediction, too") {
    const FieldExample example(5000, 0.05, 40);
    const auto found = example.choose({.disabled = {Technique::brute_force}});
    REQUIRE(found.sampled_rays > 40);
    for (const Prediction& one : found.candidates)
      if (one.candidate.technique == Technique::box_tree) CHECK(one.error > 0);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("for lines, the tests of every box tree are predicted within four standard errors") {
    const FieldExample example(20'000, 0.05, 20'000);
    int compared = 0;
    for (const Prediction& one : example.choose().candidates) {
      if (one.candidate.technique != Technique::box_tree) continue;
      const Counts<double> counted = as_expected(sim::run(*example.problem, one.candidate).counts);
      CHECK(tests(one.counts_error) < 0.2 * tests(counted));
      CHECK(std::abs(tests(one.counts) - tests(counted)) < 4 * tests(one.counts_error));
      ++compared;
    }
    CHECK(compared >= 4);
  }

  TEST_CASE("sampled segments have the workload's mean length and lie in the samples' box") {
    const FieldExample example(5000, 0.02, 5000, 0.7);
    const sim::Sphere& sphere = example.problem->enclosing();
    const auto sample = validate::structural_sample(sphere, example.workload, 2000);
    REQUIRE(sample.size() == 2000);
    double sum = 0;
    for (const sim::Ray& ray : sample) {
      sum += ray.length;
      CHECK(glm::distance(ray.origin, sphere.centre) <= sphere.radius * (1 + 1e-12));
      for (const glm::dvec3& end : {ray.origin, ray.origin + ray.length * ray.direction})
        for (int axis = 0; axis < 3; ++axis) CHECK(std::abs(end[axis] - sphere.centre[axis]) <= 1.0201);
    }
    CHECK(sum / 2000 == Approx(example.workload.path_length).epsilon(1e-9));
  }

  TEST_CASE("isotropic segments: the tests of the choice are predicted within a third") {
    const FieldExample example(20'000, 0.03, 200'000, 0.7);
    const auto found = example.choose();
    const auto& choice = found.best();
    REQUIRE(choice.candidate.technique == Technique::box_tree);
    const Counts<double> counted = as_expected(sim::run(*example.problem, choice.candidate).counts);
    CHECK(std::abs(std::log(tests(choice.counts) / tests(counted))) < std::log(1.33));
  }

  TEST_CASE("samples in a plane, and at one point, have rays") {
    for (const double extent : {1.0, 0.0}) {
      std::vector<sim::Disc> discs;
      for (int i = 0; i < 100; ++i)
        discs.push_back({{extent * (i % 10), extent * std::floor(0.1 * i), 0}, {0, 0, 1}, 1e-9});
      std::vector<sim::Ray> rays(10, sim::Ray{{0, 0, 1}, {0, 0, -1}, 2.0});
      const sim::Problem problem = sim::make_problem(rays, discs);
      const auto sample = validate::structural_sample(problem.enclosing(), sim::observe(problem).workload, 300);
      CHECK(sample.size() > 0);
      CHECK(std::all_of(sample.begin(), sample.end(), [](const sim::Ray& ray) { return ray.length > 0; }));
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a stop request, and a choice without box trees, are refused") {
    const FieldExample example(3000, 0.02, 100);
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_AS(static_cast<void>(example.choose({.stop = source.get_token()})), sim::Stopped);
    CHECK_THROWS_AS(static_cast<void>(example.choose(sim::make_problem_without_rays(example.discs, 0.1))),
                    std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(example.choose({.disabled = {Technique::box_tree}})), std::invalid_argument);
  }
}
