#include "detp/model/vocabulary/unit_costs.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "detp/model/vocabulary/cost_table.hpp"
#include "detp/model/vocabulary/thread_costs.hpp"
#include "support/not_a_length.hpp"

using namespace detp;
using doctest::Approx;

namespace {

/// Primes, so that each sum shows which costs are in it.
constexpr UnitCosts costs{.cull_test = 2,
                          .disc_test = 3,
                          .index_test = 5,
                          .step = 7,
                          .node = 11,
                          .listed = 13,
                          .placement = 17,
                          .sort = 23,
                          .cull = 29,
                          .visit = 31};

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
  TEST_CASE("each cost has its own symbol, and no cost is missing") {
    std::set<std::string_view> symbols;
    for (const UnitCostTerm& term : unit_cost_terms) symbols.insert(term.symbol);
    CHECK(symbols.size() == unit_cost_terms.size());
    CHECK(sizeof(UnitCosts) == unit_cost_terms.size() * sizeof(double));
  }

  TEST_CASE("on one thread nothing changes, whatever threads cost") {
    const CostBreakdown time = on_threads(some_time, {}, {.start = 5}, 1);
    CHECK(time.total() == some_time.total());
    const Counts<double> counts{.loaded = 1e6, .cull_tests = 1e8, .sorted = 1e5};
    CHECK(price(counts, divided_costs(), Technique::box_tree).total() ==
          price(counts, divided_costs()[Technique::box_tree]).total());
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("each part is priced by its own cost") {
    CHECK(price({.sorted = 1}, costs).order == 23);
    CHECK(price({.placements = 1}, costs).build == 17);
    CHECK(price({.bytes_touched = 1}, {.touch = 37}).touch == 37);
    CHECK(price({.cull_tests = 1}, costs).rebuild == 2);
    CHECK(price({.culls = 1}, costs).rebuild == 29);
    CHECK(price({.listed = 1}, costs).copy == 13);
    CHECK(price({.steps = 1}, costs).traverse == 7);
    CHECK(price({.nodes = 1}, costs).traverse == 11);
    CHECK(price({.disc_tests = 1}, costs).intersect == 3);
    CHECK(price({.visits = 1}, costs).intersect == 31);
    CHECK(price({.doubtful = 1, .references = 1, .hits = 1}, costs).total() == 0);
  }

  TEST_CASE("the total is the sum of the parts") {
    const Counts<double> counts{.cull_tests = 1,
                                .culls = 1,
                                .listed = 1,
                                .visits = 1,
                                .disc_tests = 1,
                                .steps = 1,
                                .nodes = 1,
                                .placements = 1,
                                .sorted = 1};
    const CostBreakdown time = price(counts, costs);
    CHECK(time.total() == time.order + time.build + time.rebuild + time.copy + time.traverse + time.intersect);
    CHECK(time.total() == 2 + 29 + 13 + 31 + 3 + 7 + 11 + 17 + 23);
    CHECK(price({}, costs).total() == 0);
  }

  TEST_CASE("a repeated search touches no memory for the first time") {
    const CostBreakdown time = price({.sorted = 2, .bytes_touched = 3}, {.sort = 5, .touch = 7});
    CHECK(time.total() == 31);
    CHECK(time.again() == 10);
  }

  TEST_CASE("of lists that exceed a near cache, half of the tests are of long lists while blocks halve") {
    constexpr double discs = 100'000;  // blocks of 2¹⁹ rays
    constexpr double near_rays = near_bytes / bytes_of_listed_ray;
    const double mean = near_rays * near_rays / 0x1p19;
    const Counts<double> counts{.loaded = 1e5, .cull_tests = mean * 1e5, .culls = 1e5, .references = discs};
    CHECK(long_tests({.loaded = 0x1p19, .cull_tests = mean * 1e5, .culls = 1e5, .references = discs}) ==
          doctest::Approx(mean * 1e5 / 2));
    CHECK(price(counts, {.cull_test = 0, .disc_test = 0, .streamed = 2}).start ==
          doctest::Approx(2 * bytes_of_listed_ray * long_tests(counts)));
  }

  TEST_CASE("lists of a near cache have no long tests; lists that are all longer have only long tests") {
    CHECK(long_tests({.loaded = 6e4, .cull_tests = 1e9, .culls = 1e3, .references = 1e5}) == 0);
    CHECK(long_tests({.loaded = 1e9, .cull_tests = 1e9, .culls = 1e3, .references = 1000}) == 0);  // blocks of 2¹⁵
    CHECK(long_tests({.loaded = 1e9, .references = 1e5}) == 0);
    const Counts<double> counts{.loaded = 1e9, .cull_tests = 1e9, .culls = 1e3, .references = 1e5};
    CHECK(long_tests(counts) == doctest::Approx(counts.cull_tests));
  }

  TEST_CASE("rays that no cache holds cost by their bytes") {
    constexpr double cached_rays = 0x1p17;
    const UnitCosts far{.ray = 3, .streamed = 5};
    CHECK(price({.loaded = cached_rays}, far).start == 3 * cached_rays);
    CHECK(price({.loaded = cached_rays + 10}, far).start == 3 * cached_rays + 30 + 50 * bytes_of_ray);
  }

  TEST_CASE("discs that no near cache holds: by the square of the doublings") {
    CHECK(far_discs({.sorted = 1e4}) == 0);
    CHECK(far_discs({.placements = 2e4}) == doctest::Approx(2e4));
    CHECK(far_discs({.visits = 8e4}) == doctest::Approx(9 * 8e4));
  }

  TEST_CASE("techniques that search rays one by one have their own cost of disc tests") {
    for (const TechniqueRecord& record : technique_records) {
      const CostBreakdown time = price({.disc_tests = 10, .placements = 10}, costs, record.technique);
      CHECK(time.intersect == (record.ray_by_ray ? 50 : 30));
      CHECK(time.build == 170);
    }
    for (const Technique one_by_one : {Technique::octree, Technique::grid, Technique::bsp})
      CHECK(record_of(one_by_one).ray_by_ray);
    for (const Technique lists : {Technique::brute_force, Technique::sphere_cache, Technique::box_tree})
      CHECK_FALSE(record_of(lists).ray_by_ray);
  }

  TEST_CASE("the ends of rays are priced in each test against a sphere, a box or a disc, by the share that ends") {
    constexpr UnitCosts of_ends{.cull_test = 0, .disc_test = 0, .step = 0, .node = 0, .ends = 3};
    constexpr Counts<double> lines{.loaded = 8, .cull_tests = 10, .disc_tests = 20};
    Counts<double> segments = lines;
    segments.segments = 8;
    CHECK(price(lines, of_ends).total() == 0);
    CHECK(price(segments, of_ends).total() == 90);
    segments.segments = 2;
    CHECK(price(segments, of_ends).total() == 22.5);
    CHECK(price({.segments = 0, .cull_tests = 10}, of_ends).total() == 0);
  }

  TEST_CASE("without measured costs, tests, steps and visits cost one and everything else costs nothing") {
    CHECK(
        price({.cull_tests = 1, .culls = 5, .listed = 5, .disc_tests = 10, .steps = 100, .nodes = 1000}, {}).total() ==
        1111);
  }

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
  TEST_CASE("an invalid time is refused by its symbol; zero is valid") {
    std::vector<double> not_a_time(support::not_a_size.begin(), support::not_a_size.end());
    not_a_time.push_back(1e201);  // times of counts up to 1e55 must not overflow
    for (const double bad : not_a_time)
      for (const UnitCostTerm& term : unit_cost_terms) {
        UnitCosts wrong;
        wrong.*term.cost = bad;
        const std::string symbol = "(" + std::string(term.symbol) + ")";
        CHECK_THROWS_WITH_AS(check(wrong), doctest::Contains(symbol.c_str()), std::invalid_argument);
      }
    for (const double good : {0.0, 1e200}) {
      UnitCosts all;
      for (const UnitCostTerm& term : unit_cost_terms) all.*term.cost = good;
      CHECK_NOTHROW(check(all));
    }
  }

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
