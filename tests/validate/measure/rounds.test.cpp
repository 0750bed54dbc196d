#include "detp/validate/measure/rounds.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

using namespace detp::validate;

namespace {

constexpr std::size_t contenders = 5;

/// The contenders of each round in their order; ends after `most_runs` runs.
std::vector<std::vector<std::size_t>> rounds_of(int rounds, int most_runs) {
  std::vector<std::vector<std::size_t>> orders;
  in_turns(contenders, rounds, [&](std::size_t i, int round) {
    orders.resize(static_cast<std::size_t>(round) + 1);
    orders[static_cast<std::size_t>(round)].push_back(i);
    return --most_runs > 0;
  });
  return orders;
}

std::vector<bool> near(const TimesOfAll& times) { return not_behind(times, 1.5); }

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
  TEST_CASE("each contender runs once in each round, in changing orders, the first of which is the given one") {
    auto orders = rounds_of(20, 1000);
    REQUIRE(orders.size() == 20);
    CHECK(std::ranges::is_sorted(orders[0]));
    CHECK(std::set(orders.begin(), orders.end()).size() > 10);
    for (auto& order : orders) {
      std::ranges::sort(order);
      CHECK(order == std::vector<std::size_t>{0, 1, 2, 3, 4});
    }
  }

  TEST_CASE("rounds end with the first run that asks for it, and without contenders nothing runs") {
    CHECK(rounds_of(20, 7).back().size() == 2);
    int runs = 0;
    in_turns(0, 3, [&](std::size_t, int) { return ++runs > 0; });
    CHECK(runs == 0);
  }

  TEST_CASE("a contender that is far behind is timed four times, the others in every round") {
    const std::array seconds{1.0, 1.4, 1.6};
    const auto times = timed_rounds(3, {.rounds = 7}, near, [&](std::size_t i, auto&&) { return seconds[i]; });
    CHECK(times[0].size() == 7);
    CHECK(times[1].size() == 7);
    CHECK(times[2].size() == 4);
  }

  TEST_CASE("a machine that changes its speed between rounds does not put equal contenders behind") {
    int runs = 0;
    const auto times =
        timed_rounds(4, {.rounds = 6}, near, [&](std::size_t, auto&&) { return runs++ < 4 ? 2.0 : 1.0; });
    for (const auto& of_one : times) CHECK(of_one.size() == 6);
  }

  TEST_CASE("the rounds end with the first run that returns nothing") {
    int runs = 0;
    const auto times =
        timed_rounds(3, {}, near, [&](std::size_t, auto&&) { return ++runs <= 4 ? std::optional(1.0) : std::nullopt; });
    CHECK(times[0].size() + times[1].size() + times[2].size() == 4);
    for (const auto& of_one : times) CHECK(!of_one.empty());
    CHECK(runs == 5);
  }

  TEST_CASE("no round begins after the time limit, and without contenders nothing is timed") {
    const auto times =
        timed_rounds(2, {.rounds = 9, .most_seconds = -1}, near, [](std::size_t, auto&&) { return 1.0; });
    CHECK(times[0].size() == 1);
    CHECK(times[1].size() == 1);
    CHECK(timed_rounds(0, {}, near, [](std::size_t, auto&&) { return 1.0; }).empty());
  }

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
    CHECK(times.usual_seconds() == 1.5);
    CHECK(times_of({{4, 3}, {1.5, 2}, {2, 9}}).usual_seconds() == 2);
  }

  TEST_CASE("without a run there is no time") {
    CHECK_FALSE(times_of({}).timed());
    CHECK_FALSE(times_of({{}}).timed());
    CHECK_FALSE(times_of({{}, {}}).agree());
    CHECK_FALSE(times_of({{0}}).timed());
  }
}
