#include "detp/validate/choice/analysis.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "detp/sim/effects/observe.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

struct Scene {
  explicit Scene(std::size_t samples, std::size_t count)
      : discs(sim::uniform_discs(sim::Body::cube, 2, samples, 0.02, 1)),
        rays(sim::LineField(sim::enclosing_sphere(discs), 2).lines(0, count)) {}

  [[nodiscard]] sim::Problem problem() const { return sim::make_problem(rays, discs); }

  /// A wrong ranking: brute force first, the sphere tree last with a predicted time of 10⁶ s.
  [[nodiscard]] std::vector<Prediction> wrong_ranking() const {
    auto ranking = model::rank(sim::observe(problem()).workload, built_in_unit_costs());
    std::reverse(ranking.begin(), ranking.end());
    for (Prediction& ranked : ranking) {
      ranked.time = {};
      if (ranked.candidate.technique == Technique::brute_force) std::swap(ranked, ranking.front());
    }
    const auto tree = std::find_if(ranking.begin(), ranking.end(), [](const Prediction& ranked) {
      return ranked.candidate.technique == Technique::sphere_tree;
    });
    std::rotate(tree, tree + 1, ranking.end());
    ranking.back().time.intersect = 1e6;
    return ranking;
  }

  std::vector<sim::Disc> discs;
  std::vector<sim::Ray> rays;
};

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("the best is the fastest measured, not predicted; the regret compares the predicted choice with it" *
            doctest::test_suite("long")) {
    const Scene scene(10'000, 10'000);  // 10⁸ tests by brute force
    const auto ranking = scene.wrong_ranking();
    REQUIRE(ranking.front().candidate.technique == Technique::brute_force);
    const Analysis analysis = analyse(scene.problem(), ranking);
    REQUIRE(analysis.best);
    const Analysed& best = analysis.candidates[*analysis.best];
    const Analysed& predicted = analysis.candidates.front();
    CHECK(predicted.candidate == ranking.front().candidate);
    CHECK(best.candidate.technique != Technique::brute_force);
    REQUIRE(predicted.seconds);
    REQUIRE(analysis.regret);
    CHECK(*analysis.regret == doctest::Approx(*predicted.seconds / *best.seconds - 1));
    CHECK(*analysis.regret > 0.5);
    for (const Analysed& one : analysis.candidates) {
      if (one.seconds) CHECK(*one.seconds >= *best.seconds);
      if (one.counted) CHECK(one.counted->hits == best.counted->hits);
      CHECK((one.counted.has_value() || one.given_up_after.has_value()));
    }
    CHECK(analysis.tried == static_cast<int>(analysis.candidates.size()));
    CHECK(analysis.tried > static_cast<int>(ranking.size()) + 2);
    CHECK_FALSE(analysis.stopped);
  }

  TEST_CASE("a candidate that takes several times as long as the fastest is abandoned" * doctest::test_suite("long")) {
    const Scene scene(50'000, 60'000);  // 3·10⁹ tests by brute force
    auto ranking = scene.wrong_ranking();
    std::reverse(ranking.begin(), ranking.end());
    const Analysis analysis = analyse(scene.problem(), ranking, {.repeats = 1});
    const auto brute_force =
        std::find_if(analysis.candidates.begin(), analysis.candidates.end(),
                     [](const Analysed& one) { return one.candidate.technique == Technique::brute_force; });
    REQUIRE(brute_force != analysis.candidates.end());
    CHECK(brute_force->given_up_after.has_value());
    CHECK_FALSE(brute_force->seconds.has_value());
    CHECK_FALSE(brute_force->counted.has_value());
  }

  TEST_CASE("an analysis stopped before its first run has no best, and says that it was stopped") {
    const Scene scene(100, 100);
    std::stop_source source;
    source.request_stop();
    const Analysis analysis = analyse(scene.problem(), scene.wrong_ranking(), {.stop = source.get_token()});
    CHECK(analysis.stopped);
    CHECK(analysis.tried == 0);
    CHECK_FALSE(analysis.best);
    CHECK_FALSE(analysis.regret);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("the error of a predicted time is split into counts and unit costs; the costliest wrong count is named") {
    const UnitCosts costs{.cull_test = 2, .disc_test = 1};
    Prediction predicted{{Technique::sphere_cache, SphereCacheParameters{}}, {.cull_tests = 10, .disc_tests = 100}};
    predicted.time = price(predicted.counts, costs, predicted.candidate.technique);  // 120
    const PredictionError error = prediction_error(predicted, {.cull_tests = 20, .disc_tests = 20}, 30, costs);
    CHECK(error.seconds == doctest::Approx(4));
    CHECK(error.counts == doctest::Approx(2));
    CHECK(error.unit_costs == doctest::Approx(2));
    CHECK(error.worst == "disc_tests");
    CHECK(error.worst_ratio == doctest::Approx(5));
  }

  TEST_CASE("if all counts are right, only the unit costs are wrong") {
    const UnitCosts costs{.index_test = 3, .step = 1};
    Prediction predicted{{Technique::grid, GridParameters{4}}, {.disc_tests = 10, .steps = 5}};
    predicted.time = price(predicted.counts, costs, predicted.candidate.technique);  // 35
    const PredictionError error = prediction_error(predicted, {.disc_tests = 10, .steps = 5}, 7, costs);
    CHECK(error.counts == doctest::Approx(1));
    CHECK(error.unit_costs == doctest::Approx(5));
    CHECK(error.worst_ratio == 1);
  }
}
