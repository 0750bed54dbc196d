#include "detp/validate/calibration/timed_workloads.hpp"

#include <doctest/doctest.h>

using detp::validate::RoundTimes;

namespace {

RoundTimes times_of(std::initializer_list<std::initializer_list<double>> rounds) {
  RoundTimes times;
  for (const auto& round : rounds) {
    times.begin_round();
    for (const double seconds : round) times.add(seconds, seconds / 2);
  }
  return times;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("times agree once the shortest times of two rounds do, not two times of one round") {
    CHECK_FALSE(times_of({}).agree());
    CHECK_FALSE(times_of({{1, 1, 1}}).agree());
    CHECK_FALSE(times_of({{1, 1}, {2, 1.2}}).agree());
    CHECK(times_of({{1, 9}, {5, 1.04}}).agree());
    CHECK(times_of({{4}, {3}, {1}, {2}, {1.02}}).agree());
  }

  TEST_CASE("the shortest times count, of all rounds") {
    const RoundTimes times = times_of({{4, 3}, {1.5, 2}});
    CHECK(times.seconds() == 1.5);
    CHECK(times.preparing() == 0.75);
    CHECK(times.timed());
    CHECK(times.usual_over_shortest() == 1);
    CHECK(times_of({{4, 3}, {1.5, 2}, {2, 9}}).usual_over_shortest() == doctest::Approx(2 / 1.5));
  }

  TEST_CASE("without a run there is no time") {
    CHECK_FALSE(times_of({}).timed());
    CHECK_FALSE(times_of({{}}).timed());
    CHECK_FALSE(times_of({{}, {}}).agree());
    CHECK_FALSE(times_of({{0}}).timed());
  }
}
