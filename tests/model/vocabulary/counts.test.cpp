#include "detp/model/vocabulary/counts.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <set>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "detp/model/vocabulary/units.hpp"
#include "support/not_a_length.hpp"

using namespace detp;

namespace {

/// Powers of two, so that each sum tells its terms.
template <class T>
Counts<T> powers() {
  Counts<T> counts;
  T value = 1;
  for_each_term(counts, [&](std::string_view, T& term) {
    term = value;
    value *= 2;
  });
  return counts;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("each term is visited once, by a name of its own, and the terms are all there is") {
    std::set<std::string_view> names;
    std::vector<double> values;
    for_each_term(powers<double>(), [&](std::string_view name, double term) {
      names.insert(name);
      values.push_back(term);
    });
    CHECK(names.size() == 10);
    CHECK(values.size() == 10);
    CHECK(sizeof(Counts<double>) == 10 * sizeof(double));
    CHECK(values.back() == 512);
  }

  TEST_CASE("an observation turns into the same numbers") {
    CHECK(as_expected(powers<std::uint64_t>()) == powers<double>());
    CHECK(as_expected(Counts<std::uint64_t>{}) == Counts<double>{});
  }

  TEST_CASE("the total is the sum of the parts, and is linear in counts and in costs") {
    const UnitCosts costs{.sphere_test = 2,
                          .disc_test = 3,
                          .index_test = 4,
                          .step = 5,
                          .node = 7,
                          .copy = 11,
                          .placement = 13,
                          .sort = 17,
                          .rebuild = 19};
    const Counts<double> c = powers<double>();
    const CostBreakdown time = price(c, costs);
    CHECK(time.total() == time.order + time.build + time.rebuild + time.copy + time.traverse + time.intersect);
    CHECK(time.total() == 2 * c.sphere_tests + 3 * c.disc_tests + 5 * c.steps + 7 * c.nodes + 11 * c.copies +
                              13 * c.placements + 17 * c.sorted + 19 * c.rebuilds);
    CHECK(price({}, costs).total() == 0);
    CHECK(price(c, {0, 0, 0, 0, 0, 0, 0, 0, 0}).total() == 0);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("each part is priced by its own cost") {
    const UnitCosts costs{.sphere_test = 2,
                          .disc_test = 3,
                          .index_test = 4,
                          .step = 5,
                          .node = 7,
                          .copy = 11,
                          .placement = 13,
                          .sort = 17,
                          .rebuild = 19};
    CHECK(price({.sorted = 1}, costs).order == 17);
    CHECK(price({.placements = 1}, costs).build == 13);
    CHECK(price({.sphere_tests = 1}, costs).rebuild == 2);
    CHECK(price({.rebuilds = 1}, costs).rebuild == 19);
    CHECK(price({.copies = 1}, costs).copy == 11);
    CHECK(price({.steps = 1}, costs).traverse == 5);
    CHECK(price({.nodes = 1}, costs).traverse == 7);
    CHECK(price({.disc_tests = 1}, costs).intersect == 3);
    CHECK(price({.references = 1, .hits = 1}, costs).total() == 0);
  }

  TEST_CASE("a disc test in an index has a cost of its own") {
    const UnitCosts costs{.disc_test = 3, .index_test = 4};
    for (const Technique technique : {Technique::octree, Technique::grid, Technique::bsp})
      CHECK(price({.disc_tests = 10}, costs, technique).intersect == 40);
    for (const Technique technique :
         {Technique::brute_force, Technique::sphere_cache, Technique::cell_spheres, Technique::sphere_tree})
      CHECK(price({.disc_tests = 10}, costs, technique).intersect == 30);
  }

  TEST_CASE("tests are those of spheres and discs together") {
    CHECK(tests(Counts<std::uint64_t>{.sphere_tests = 3, .disc_tests = 4, .steps = 100}) == 7);
  }

  TEST_CASE("without measured costs, tests and steps cost one, all else nothing") {
    CHECK(price({.sphere_tests = 1, .disc_tests = 10, .steps = 100, .nodes = 1000, .copies = 5, .rebuilds = 5}, {})
              .total() == 1111);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a time that is none is refused by name; zero is one") {
    struct Named {
      double UnitCosts::*time;
      const char* name;
    };
    std::vector<double> not_a_time(support::not_a_size.begin(), support::not_a_size.end());
    not_a_time.push_back(1e201);  // times of counts up to 1e55 must not overflow
    for (const double bad : not_a_time)
      for (const auto& [time, name] :
           {Named{&UnitCosts::sphere_test, "ray-sphere"}, Named{&UnitCosts::disc_test, "ray-disc"},
            Named{&UnitCosts::index_test, "disc in a cell"}, Named{&UnitCosts::step, "step"},
            Named{&UnitCosts::node, "node"}, Named{&UnitCosts::copy, "copy"}, Named{&UnitCosts::placement, "placing"},
            Named{&UnitCosts::sort, "sorting"}, Named{&UnitCosts::rebuild, "rebuild"}}) {
        UnitCosts costs;
        costs.*time = bad;
        CHECK_THROWS_WITH_AS(check(costs), doctest::Contains(name), std::invalid_argument);
      }
    for (const double good : {0.0, 1e200})
      CHECK_NOTHROW(check(UnitCosts{good, good, good, good, good, good, good, good, good}));
  }
}
