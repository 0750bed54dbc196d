#include "detp/validate/axes/axes.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/search/problem.hpp"
#include "detp/validate/axes/owen_sobol.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"

namespace detp::validate {
namespace {

const AxisPoint& starting_with(const std::vector<AxisPoint>& points, const std::string& start) {
  const auto found = std::ranges::find_if(points, [&](const AxisPoint& one) { return one.setting.starts_with(start); });
  REQUIRE_MESSAGE(found != points.end(), start);
  return *found;
}

}  // namespace

TEST_SUITE("Sobol points") {
  TEST_CASE("scrambled points: one in each interval of each coordinate; the first two share each square of 2^k cells") {
    for (const std::uint64_t seed : {1, 2, 77}) {
      const OwenSobol points(seed);
      for (int bits = 1; bits <= 10; ++bits) {
        const std::uint32_t count = 1U << bits;
        for (std::size_t dimension = 0; dimension < 4; ++dimension) {
          std::set<int> cells;
          for (std::uint32_t i = 0; i < count; ++i) cells.insert(static_cast<int>(points.point(i)[dimension] * count));
          CHECK(cells.size() == count);
        }
        for (int first = 0; first <= bits; ++first) {
          std::set<std::pair<int, int>> boxes;
          for (std::uint32_t i = 0; i < count; ++i) {
            const auto point = points.point(i);
            boxes.insert(
                {static_cast<int>(std::ldexp(point[0], first)), static_cast<int>(std::ldexp(point[1], bits - first))});
          }
          CHECK(boxes.size() == count);
        }
      }
    }
  }

  TEST_CASE("replicates differ, and each coordinate's mean over replicates is uniform") {
    double mean = 0;
    for (std::uint64_t seed = 1; seed <= 4000; ++seed) mean += OwenSobol(seed).point(5)[3] / 4000;
    CHECK(std::abs(mean - 0.5) < 5 / std::sqrt(12 * 4000.0));
    CHECK(OwenSobol(1).point(5) != OwenSobol(2).point(5));
  }
}

TEST_SUITE("axes") {
  TEST_CASE("simulation: random lines have the error of the binomial distribution; better ways have less" *
            doctest::test_suite("long")) {
    const auto discs = sim::uniform_discs(sim::Body::cube, 2, 64, 0.3, 1);
    const auto points = simulation_axis(discs, {});
    REQUIRE(points.size() == 10);
    const double probability = 0.5 * std::pow(0.3 / sim::enclosing_sphere(discs).radius, 2);
    const AxisPoint& plain = starting_with(points, "plain, 4096");
    CHECK(plain.error == doctest::Approx(std::sqrt((1 - probability) / probability / 4096)).epsilon(0.2));
    CHECK(plain.interval.value().low < plain.error);
    CHECK(plain.interval.value().high > plain.error);
    CHECK(plain.seconds > 0);
    CHECK(starting_with(points, "stratified, 32768").error < 0.9 * starting_with(points, "plain, 32768").error);
    CHECK(starting_with(points, "Owen-scrambled Sobol, 32768").error <
          0.7 * starting_with(points, "plain, 32768").error);
    // a cosine's relative variance is 1/3
    const AxisPoint& conditioned = starting_with(points, "conditioned on direction, 4096");
    CHECK(conditioned.error == doctest::Approx(std::sqrt(1.0 / 3 / 4096)).epsilon(0.3));
    CHECK(starting_with(points, "conditioned, Owen-scrambled Sobol, 32768").error < 0.05 * conditioned.error);
  }

  TEST_CASE("arithmetic: float loses hits far from the origin; the filter and double lose none" *
            doctest::test_suite("long")) {
    const auto points = arithmetic_axis({});
    REQUIRE(points.size() == 8);
    CHECK(starting_with(points, "float, hard").error > 0.1);
    for (const char* right :
         {"float, filtered, ordinary", "float, filtered, hard", "double, ordinary", "double, hard"}) {
      CAPTURE(right);
      const AxisPoint& point = starting_with(points, right);
      CHECK(point.error == 0);
      CHECK(point.interval.value().high > 0);  // nothing wrong is a bound
    }
    CHECK(starting_with(points, "exact, hard").seconds > starting_with(points, "double, hard").seconds);
  }

  TEST_CASE("model: predictions of tests are near the full run's, and only those with a known error have an interval") {
    const auto discs = sim::uniform_discs(sim::Body::cube, 2, 20'000, 0.05, 1);
    const auto rays = sim::LineField(sim::enclosing_sphere(discs), 3).lines(0, 100'000);
    const auto points = model_axis({rays}, discs, built_in_unit_costs(Engine::simd), {});
    for (const char* rigor : {"estimate", "structural", "pilot"}) {
      CAPTURE(rigor);
      const AxisPoint& point = starting_with(points, rigor);
      CHECK(point.error < 0.3);
      CHECK(point.seconds > 0);
    }
    CHECK_FALSE(starting_with(points, "estimate").interval.has_value());
    CHECK(starting_with(points, "pilot").interval.has_value());
  }

  TEST_CASE("a stop request ends each axis") {
    std::stop_source stop;
    stop.request_stop();
    const AxisOptions stopped{.seed = 1, .threads = 0, .stop = stop.get_token()};
    const auto discs = sim::uniform_discs(sim::Body::cube, 2, 64, 0.3, 1);
    CHECK_THROWS_AS(static_cast<void>(simulation_axis(discs, stopped)), sim::Stopped);
    CHECK_THROWS_AS(static_cast<void>(arithmetic_axis(stopped)), sim::Stopped);
    const auto rays = sim::LineField(sim::enclosing_sphere(discs), 3).lines(0, 1000);
    CHECK_THROWS_AS(static_cast<void>(model_axis({rays}, discs, built_in_unit_costs(Engine::simd), stopped)),
                    sim::Stopped);
  }
}

}  // namespace detp::validate
