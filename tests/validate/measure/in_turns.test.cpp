#include "detp/validate/measure/in_turns.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <vector>

using detp::validate::in_turns;

namespace {

constexpr std::size_t contenders = 5;

/// The contenders of each round in their order; ends after `most_runs` runs.
std::vector<std::vector<std::size_t>> rounds_of(int rounds, int most_runs) {
  std::vector<std::vector<std::size_t>> orders;
  const auto begin = [&](int round) {
    CHECK(orders.size() == static_cast<std::size_t>(round));
    orders.emplace_back();
    return true;
  };
  in_turns(contenders, rounds, begin, [&](std::size_t i, int round) {
    orders[static_cast<std::size_t>(round)].push_back(i);
    return --most_runs > 0;
  });
  return orders;
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

  TEST_CASE("rounds end with the first run or beginning that asks for it") {
    CHECK(rounds_of(20, 7).back().size() == 2);
    int begun = 0;
    int runs = 0;
    in_turns(
        contenders, 20, [&](int round) { return ++begun > 0 && round < 3; },
        [&](std::size_t, int) { return ++runs > 0; });
    CHECK(begun == 4);
    CHECK(runs == 3 * static_cast<int>(contenders));
  }

  TEST_CASE("without contenders no round begins") {
    int begun = 0;
    in_turns(
        0, 3, [&](int) { return ++begun > 0; }, [](std::size_t, int) { return true; });
    CHECK(begun == 0);
  }
}
