#include "detp/validate/base/in_turns.hpp"

#include <doctest/doctest.h>

#include <utility>
#include <vector>

using detp::validate::in_turns;

TEST_SUITE("known answer") {
  TEST_CASE("each contender runs once in each round, until one ends the rounds") {
    std::vector<std::pair<std::size_t, int>> turns;
    in_turns(3, 2, [&](std::size_t i, int round) {
      turns.emplace_back(i, round);
      return !(i == 1 && round == 1);
    });
    CHECK(turns == std::vector<std::pair<std::size_t, int>>{{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}});
  }
}
