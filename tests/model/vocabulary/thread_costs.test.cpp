#include "detp/model/vocabulary/thread_costs.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <stdexcept>

#include "detp/model/vocabulary/cost_table.hpp"

using namespace detp;
using doctest::Approx;

namespace {

constexpr CostBreakdown some_time{.order = 1, .build = 3, .rebuild = 2, .copy = 4, .intersect = 10};

/// Costs with which a box tree's tests take time, and threads divide nine tenths of the search.
CostTable divided_costs() {
  UnitCosts costs;
  for (const UnitCostTerm& term : unit_cost_terms) costs.*term.cost = 0;
  costs.cull_test = 1e-9;
  CostTable table(costs);
  table.threads_of(Technique::box_tree) = {.serial_preparing = 0.5, .serial_search = 0.1, .start = 1e-5};
  return table;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("on one thread nothing changes, whatever threads cost") {
    const CostBreakdown time = on_threads(some_time, {}, {.start = 5}, 1);
    CHECK(time.total() == some_time.total());
    const Counts<double> counts{.loaded = 1e6, .cull_tests = 1e8, .sorted = 1e5};
    CHECK(price(counts, divided_costs(), Technique::box_tree).total() ==
          price(counts, divided_costs()[Technique::box_tree]).total());
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("each phase follows Amdahl's law, and each further thread takes its time to start") {
    const CostBreakdown time =
        on_threads(some_time, {1e6, 1e6}, {.serial_preparing = 0.5, .serial_search = 0.25, .start = 7}, 4);
    CHECK(time.order + time.build == Approx(4 * (0.5 + 0.5 / 4)));
    CHECK(time.rebuild + time.copy + time.intersect == Approx(16 * (0.25 + 0.75 / 4)));
    CHECK(time.start == 21);
  }

  TEST_CASE("discs that are visited again for each block of rays cost time of the search, not of building") {
    CostTable costs = divided_costs();
    costs[Technique::box_tree].cull_test = 0;
    costs[Technique::box_tree].far = 1e-9;
    costs.threads_of(Technique::box_tree) = {.serial_preparing = 1, .serial_search = 0, .start = 0};
    const Counts<double> counts{.loaded = 1e8, .visits = 1e7, .sorted = 1e5};
    const double one = price(counts, costs, Technique::box_tree).total();
    CHECK(one == Approx(price(counts, costs[Technique::box_tree]).total()));
    const double building = 1e-9 * far_discs({.sorted = 1e5});
    CHECK(price(counts, costs, Technique::box_tree, 2).total() == Approx(building + (one - building) / 2));
    const Counts<double> built{.loaded = 1e8, .visits = 1e7, .sorted = 1e7};
    CHECK(price(built, costs, Technique::box_tree, 2).total() ==
          Approx(price(built, costs, Technique::box_tree).total()));
  }

  TEST_CASE("three equal pieces keep 1.5 of two threads busy, and three of four") {
    CHECK(busy_threads(3, 2) == 1.5);
    CHECK(busy_threads(3, 4) == 3);
    CHECK(busy_threads(0.5, 8) == 1);
    CHECK(busy_threads(1e12, 8) == Approx(8));
  }

  TEST_CASE("the numbers of threads are powers of two and the largest") {
    CHECK(thread_numbers(1) == std::vector<int>{1});
    CHECK(thread_numbers(2) == std::vector<int>{1, 2});
    CHECK(thread_numbers(6) == std::vector<int>{1, 2, 4, 6});
  }

  TEST_CASE("a tiny search takes one thread, a large one all") {
    const auto best = [](double rays) {
      const Counts<double> counts{.loaded = rays, .cull_tests = 100 * rays, .sorted = 1e5};
      return fastest_price(counts, divided_costs(), Technique::box_tree, 6);
    };
    CHECK(best(100).threads == 1);
    CHECK(best(1e6).threads == 6);
    CHECK(best(1e6).time.total() == Approx(0.1 * (0.1 + 0.9 / 6) + 5e-5).epsilon(0.01));
  }

  TEST_CASE("a technique whose search one thread does takes one thread") {
    const Counts<double> counts{.loaded = 1e6, .cull_tests = 1e9, .visits = 1e5, .disc_tests = 1e9, .sorted = 1e5};
    CostTable costs(UnitCosts{});
    costs.threads.fill({.serial_preparing = 0, .serial_search = 0});
    for (const Technique alone : {Technique::sphere_tree, Technique::ray_map})
      CHECK(fastest_price(counts, costs, alone, 8).threads == 1);
    CHECK(fastest_price(counts, costs, Technique::sphere_cache, 8).threads == 4);  // three axes
    CHECK(fastest_price(counts, costs, Technique::grid, 8).threads == 8);
    costs.engine = Engine::plain;
    CHECK(fastest_price(counts, costs, Technique::sphere_cache, 8).threads == 1);
    CHECK(fastest_price(counts, costs, Technique::brute_force, 8).threads == 8);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a share out of 0 to 1 and a negative time are refused") {
    for (const double bad : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN()}) {
      CHECK_THROWS_AS(check(ThreadCosts{.serial_preparing = bad}), std::invalid_argument);
      CHECK_THROWS_AS(check(ThreadCosts{.serial_search = bad}), std::invalid_argument);
    }
    CHECK_THROWS_AS(check(ThreadCosts{.start = -1}), std::invalid_argument);
    CostTable costs;
    costs.threads_of(Technique::grid).serial_search = 2;
    CHECK_THROWS_WITH_AS(check(costs), doctest::Contains("grid: serial share of the search"), std::invalid_argument);
  }
}
