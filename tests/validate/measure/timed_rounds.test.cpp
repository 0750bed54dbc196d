#include "detp/validate/measure/timed_rounds.hpp"

#include <doctest/doctest.h>

#include <array>

using namespace detp;

TEST_SUITE("known answer") {
  TEST_CASE("a contender that is far behind is timed four times, the others in every round") {
    const std::array seconds{1.0, 1.4, 1.6};
    const auto times =
        validate::timed_rounds(3, {.rounds = 7, .behind = 1.5}, [&](std::size_t i) { return seconds[i]; });
    CHECK(times[0].size() == 7);
    CHECK(times[1].size() == 7);
    CHECK(times[2].size() == 4);
  }

  TEST_CASE("a machine that changes its speed between rounds does not put equal contenders behind") {
    int runs = 0;
    const auto times =
        validate::timed_rounds(4, {.rounds = 6, .behind = 1.5}, [&](std::size_t) { return runs++ < 4 ? 2.0 : 1.0; });
    for (const auto& of_one : times) CHECK(of_one.size() == 6);
  }

  TEST_CASE("the rounds end with the first run that returns nothing") {
    int runs = 0;
    const auto times =
        validate::timed_rounds(3, {}, [&](std::size_t) { return ++runs <= 4 ? std::optional(1.0) : std::nullopt; });
    CHECK(times[0].size() + times[1].size() + times[2].size() == 4);
    for (const auto& of_one : times) CHECK(!of_one.empty());
    CHECK(runs == 5);
  }

  TEST_CASE("no round begins after the time limit, and without contenders nothing is timed") {
    const auto times = validate::timed_rounds(2, {.rounds = 9, .most_seconds = -1}, [](std::size_t) { return 1.0; });
    CHECK(times[0].size() == 1);
    CHECK(times[1].size() == 1);
    CHECK(validate::timed_rounds(0, {}, [](std::size_t) { return 1.0; }).empty());
  }
}
