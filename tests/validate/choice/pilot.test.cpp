#include "detp/validate/choice/choice.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/choice/pilot.hpp"

using namespace detp;
using doctest::Approx;

namespace {

struct Example {
  Example(std::size_t samples, double radius, std::size_t count)
      : discs(sim::uniform_discs(sim::Body::cube_faces, 2, samples, radius, 3)),
        rays(sim::LineField(sim::enclosing_sphere(discs), 4).lines(0, count)),
        problem(sim::make_problem(rays, discs)) {}

  std::vector<sim::Disc> discs;
  std::vector<sim::Ray> rays;
  sim::Problem problem;
};

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("each exact technique is a candidate, ruled out or not examined") {
    for (const std::size_t rays : {1UL, 300UL, 20'000UL}) {
      const Example example(5000, 0.02, rays);
      const auto found = validate::choose({.problem = &example.problem}, validate::built_in_unit_costs());
      std::map<Technique, int> places;
      for (const auto& one : found.candidates) places[one.candidate.technique] |= 1;
      for (const auto& one : found.ruled_out) places[one.technique] |= 2;
      for (const Technique technique : found.unexamined) places[technique] |= 4;
      for (const TechniqueRecord& record : technique_records) {
        CAPTURE(record.name);
        const int place = places[record.technique];
        CHECK((place == 1 || place == 2 || place == 4) == record.exact);
      }
      for (std::size_t i = 2; i < found.candidates.size(); ++i)
        CHECK(found.candidates[i - 1].time.total() <= found.candidates[i].time.total());
      for (const auto& one : found.ruled_out) CHECK(one.seconds >= found.best().time.total());
    }
  }

  TEST_CASE("rays that end are predicted as segments, by box trees and by brute force") {
    for (const std::size_t rays : {2UL, 5000UL}) {
      Example example(2000, 0.02, rays);
      const auto lines = validate::choose({.problem = &example.problem}, validate::built_in_unit_costs());
      for (sim::Ray& ray : example.rays) ray.length = 2;
      const sim::Problem of_segments = sim::make_problem(example.rays, example.discs);
      const auto segments = validate::choose({.problem = &of_segments}, validate::built_in_unit_costs());
      for (const Prediction& one : lines.candidates) CHECK(one.counts.segments == 0);
      for (const Prediction& one : segments.candidates) CHECK(one.counts.segments == static_cast<double>(rays));
    }
  }

  TEST_CASE("the same rays and discs give the same choice and the same predictions") {
    const Example example(5000, 0.02, 5000);
    const auto one = validate::choose({.problem = &example.problem}, validate::built_in_unit_costs());
    const auto again = validate::choose({.problem = &example.problem}, validate::built_in_unit_costs());
    REQUIRE(one.candidates.size() == again.candidates.size());
    for (std::size_t i = 0; i < one.candidates.size(); ++i) {
      CHECK(one.candidates[i].candidate == again.candidates[i].candidate);
      CHECK(one.candidates[i].counts == again.candidates[i].counts);
    }
  }

  TEST_CASE("if only the choice matters, a short search takes the usual shape without a pilot; a long one is piloted") {
    const Example small(5000, 0.02, 5000);
    auto choice = validate::choose({.problem = &small.problem, .purpose = validate::Purpose::one_search},
                                   validate::built_in_unit_costs());
    CHECK(choice.best().source == Source::guess);
    CHECK(choice.sampled_rays == 0);
    CHECK(choice.discs == nullptr);
    REQUIRE(choice.candidates.size() == 1);
    const Candidate tree = choice.best().candidate;
    const UnitCosts costs = validate::built_in_unit_costs()[Technique::box_tree];
    CHECK(tree == Candidate{Technique::box_tree, validate::usual_shape(5000, 5000, costs.placement / costs.disc_test)});
    const auto index = validate::build_choice(choice, small.problem, {});
    CHECK(sim::run(small.problem, *index).hits == sim::run(small.problem, tree).hits);
    CHECK(validate::choose({.problem = &small.problem}, validate::built_in_unit_costs()).best().source ==
          Source::sample);
    const Example large(5000, 0.002, 1'000'000);
    const auto piloted = validate::choose({.problem = &large.problem, .purpose = validate::Purpose::one_search},
                                          validate::built_in_unit_costs());
    CHECK(piloted.best().source == Source::sample);
    CHECK(piloted.sampled_rays > 0);
  }

  TEST_CASE("on more threads, a candidate has the same counts; only its time may be another") {
    const Example example(5000, 0.02, 5000);
    const auto one = validate::choose({.problem = &example.problem}, validate::built_in_unit_costs());
    const auto two = validate::choose({.problem = &example.problem, .threads = 2}, validate::built_in_unit_costs());
    std::size_t shared = 0;
    for (const Prediction& candidate : one.candidates)
      for (const Prediction& other : two.candidates)
        if (candidate.candidate == other.candidate) {
          ++shared;
          CHECK(candidate.counts == other.counts);
          CHECK(other.time.total() <= candidate.time.total());
        }
    CHECK(shared > one.candidates.size() / 2);
  }

  TEST_CASE("with the same radius and rays, the choice is the same again") {
    for (const std::size_t rays : {1UL, 30UL, 300UL, 20'000UL}) {
      CAPTURE(rays);
      const Example example(5000, 0.02, rays);
      const auto costs = validate::built_in_unit_costs();
      const auto first =
          validate::choose({.problem = &example.problem, .purpose = validate::Purpose::replans, .threads = 1}, costs);
      const auto again =
          validate::choose_again(first, {.problem = &example.problem}, 1, static_cast<double>(rays), costs);
      REQUIRE(again.candidates.size() == first.candidates.size());
      for (std::size_t i = 0; i < first.candidates.size(); ++i) {
        CHECK(again.candidates[i].candidate == first.candidates[i].candidate);
        CHECK(again.candidates[i].time.total() == Approx(first.candidates[i].time.total()));
      }
      REQUIRE(again.ruled_out.size() == first.ruled_out.size());
      for (std::size_t i = 0; i < first.ruled_out.size(); ++i)
        CHECK(again.ruled_out[i].seconds == Approx(first.ruled_out[i].seconds));
      CHECK(again.unexamined == first.unexamined);
    }
  }

  TEST_CASE("the choice's index finds the hits of brute force, with the counts of a run of its own") {
    const Example example(5000, 0.02, 5000);
    auto found = validate::choose({.problem = &example.problem}, validate::built_in_unit_costs());
    const Candidate choice = found.best().candidate;
    const auto index = validate::build_choice(found, example.problem, {});
    const sim::Outcome outcome = sim::run(example.problem, *index);
    const sim::Outcome alone = sim::run(example.problem, choice);
    CHECK(outcome.hits == sim::run(example.problem, {Technique::brute_force, BruteForceParameters{}}).hits);
    CHECK(outcome.irradiance == alone.irradiance);
    CHECK(outcome.counts == alone.counts);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("the tests and hits of the choice are predicted within three standard errors") {
    const Example example(20'000, 0.05, 20'000);
    const auto found = validate::choose({.problem = &example.problem}, validate::built_in_unit_costs());
    CHECK(found.sampled_rays < example.rays.size() / 10);
    const auto& choice = found.best();
    REQUIRE(choice.candidate.technique == Technique::box_tree);
    const Counts<double> counted = as_expected(sim::run(example.problem, choice.candidate).counts);
    CHECK(choice.error > 0.5 * choice.time.total());  // that of the built-in costs
    CHECK(choice.error < 0.6 * choice.time.total());
    const Counts<double>& error = choice.counts_error;
    CHECK(tests(error) < 0.3 * tests(counted));
    CHECK(std::abs(tests(choice.counts) - tests(counted)) < 3 * tests(error));
    CHECK(std::abs(choice.counts.hits - counted.hits) < 3 * error.hits);
  }

  TEST_CASE("if only fronts count, half of the hits of lines are predicted, and as many tests") {
    const Example example(3000, 0.05, 2000);
    const sim::Problem fronts = sim::make_problem(example.rays, example.discs, true);
    const auto of_both = validate::choose({.problem = &example.problem}, validate::built_in_unit_costs());
    const auto of_fronts = validate::choose({.problem = &fronts}, validate::built_in_unit_costs());
    CHECK(of_fronts.best().counts.disc_tests == of_both.best().counts.disc_tests);
    CHECK(of_fronts.best().counts.hits == Approx(0.5 * of_both.best().counts.hits).epsilon(0.35));
  }

  TEST_CASE("two rays do not pay for sorting: brute force is chosen") {
    const Example example(500, 0.02, 2);
    const auto found = validate::choose({.problem = &example.problem}, validate::built_in_unit_costs());
    CHECK(found.best().candidate.technique == Technique::brute_force);
    CHECK(found.best().counts.disc_tests == 1000);
    CHECK(found.sampled_rays == 0);
    CHECK(found.discs == nullptr);
  }

  TEST_CASE("few rays take one thread, many take all: with given costs, and never more than the cap") {
    CostTable costs = validate::built_in_unit_costs();
    costs.threads.fill({.serial_preparing = 0.5, .serial_search = 0.1, .start = 1e-3});
    const Example example(5000, 0.02, 1000);
    const int cores = sim::useful_threads(0);
    const auto chosen = [&](double rays, int cap) {
      return validate::choose({.problem = &example.problem, .rays = example.rays, .ray_count = rays, .threads = cap},
                              costs)
          .best();
    };
    CHECK(chosen(2, cores).threads == 1);
    CHECK(chosen(1e8, cores).threads == cores);
    CHECK(chosen(1e8, 1).threads == 1);
    const double one = chosen(1e8, 1).time.total();
    CHECK(chosen(1e8, cores).time.total() == Approx(one * (0.1 + 0.9 / cores)).epsilon(0.02));
  }

  TEST_CASE("a sample stands for the number of rays that is given") {
    const Example example(5000, 0.02, 1000);
    const auto few = validate::choose({.problem = &example.problem, .rays = example.rays, .ray_count = 1e3},
                                      validate::built_in_unit_costs());
    const auto many = validate::choose({.problem = &example.problem, .rays = example.rays, .ray_count = 1e9},
                                       validate::built_in_unit_costs());
    CHECK(many.best().counts.loaded == 1e9);
    CHECK(many.best().counts.hits == Approx(1e6 * few.best().counts.hits).epsilon(0.2));
    CHECK(many.best().time.total() > 1e5 * few.best().time.total());
  }
}

TEST_SUITE("degenerate input") {
  TEST_CASE("discs in a point or on a line, tiny discs, rays that miss all: finite predictions, the same hits") {
    const auto rays = sim::LineField({{0, 0, 0}, 2}, 4).lines(0, 3000);
    for (const double radius : {1e-8, 1e-3, 1.0})
      for (const double length : {0.0, 1.0, 1e9}) {
        INFO("radius ", radius, ", length ", length);
        std::vector<sim::Disc> discs;
        for (int i = 0; i < 2000; ++i) discs.push_back({.centre = {length * i / 2000, 0, 0}, .radius = radius});
        const sim::Problem problem = sim::make_problem(rays, discs);
        auto found = validate::choose({.problem = &problem}, validate::built_in_unit_costs());
        for (const auto& one : found.candidates) {
          CHECK(one.time.total() > 0);
          CHECK(std::isfinite(one.time.total()));
          CHECK(std::isfinite(one.error));
          for_each_term(one.counts, [](std::string_view, double count) { CHECK(std::isfinite(count)); });
        }
        const auto index = validate::build_choice(found, problem, {});
        CHECK(sim::run(problem, *index).total_hits ==
              sim::run(problem, {Technique::brute_force, BruteForceParameters{}}).total_hits);
      }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("no rays, rays too far away for floats, and a stop request") {
    const Example example(500, 0.02, 100);
    const CostTable costs = validate::built_in_unit_costs();
    validate::Choice nothing;
    nothing.rigor = Rigor::pilot;
    const sim::Problem no_rays = sim::make_problem_without_rays(example.discs, 10);
    CHECK_THROWS_AS(
        static_cast<void>(validate::choose({.problem = &no_rays, .ray_count = 1, .rigor = Rigor::pilot}, costs)),
        std::invalid_argument);
    const auto piloted = validate::choose({.problem = &example.problem, .purpose = validate::Purpose::replans}, costs);
    for (const double ratio : {0.0, -1.0, std::nan("")})
      CHECK_THROWS_AS(
          static_cast<void>(validate::choose_again(piloted, {.problem = &example.problem}, ratio, 10, costs)),
          std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(validate::choose_again(piloted, {.problem = &example.problem}, 1, 0, costs)),
                    std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(validate::choose_again(nothing, {.problem = &example.problem}, 1, 10, costs)),
                    std::invalid_argument);
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_AS(
        static_cast<void>(validate::choose({.problem = &example.problem, .stop = source.get_token()}, costs)),
        sim::Stopped);
    const std::vector<sim::Ray> far{{.origin = {1e13, 0, 0}, .direction = {-1, 0, 0}}};
    const sim::Problem problem = sim::make_problem(far, example.discs);
    CHECK_THROWS_AS(static_cast<void>(validate::choose({.problem = &problem, .rigor = Rigor::pilot}, costs)),
                    std::invalid_argument);
    const CostTable plain = validate::built_in_unit_costs(Engine::plain);
    CHECK_THROWS_AS(static_cast<void>(validate::choose({.problem = &example.problem, .rigor = Rigor::pilot}, plain)),
                    std::invalid_argument);
  }
}
