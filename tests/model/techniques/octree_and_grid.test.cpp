#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>

#include "detp/model/disc_index/disc_index.hpp"
#include "detp/model/techniques/registry.hpp"
#include "support/random_workload.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Approx;
using doctest::Contains;

namespace {

const Workload in_cube = cube_workload(1e5, 1e5, 0.005, 2);

double octree_time(const Workload& workload, int depth, const UnitCosts& costs) {
  return price(octree_counts(workload, {depth}), costs, Technique::octree).total();
}

double grid_time(const Workload& workload, int cells, const UnitCosts& costs) {
  return price(grid_counts(workload, {cells}), costs, Technique::grid).total();
}

template <class P>
P best(const Workload& workload, const UnitCosts& costs, const SearchLimits& limits = {}) {
  constexpr Technique technique = std::is_same_v<P, GridParameters> ? Technique::grid : Technique::octree;
  return std::get<P>(model_of(technique).best(workload, costs, {}, limits).value().parameters);
}

int best_octree_depth(const Workload& workload, const UnitCosts& costs, const SearchLimits& limits = {}) {
  return best<OctreeParameters>(workload, costs, limits).depth;
}

int best_grid_cells(const Workload& workload, const UnitCosts& costs) {
  return best<GridParameters>(workload, costs).cells;
}

UnitCosts random_costs(support::RandomNumbers& random) {
  UnitCosts costs;
  costs.index_test = random.log_uniform(0.1, 10);
  costs.node = random.log_uniform(0.1, 10);
  costs.step = random.log_uniform(0.1, 10);
  costs.placement = random.log_uniform(0.1, 100);
  return costs;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("no depth from 1 up is faster than the best") {
    support::RandomNumbers random(4);
    for (int run = 0; run < 100; ++run) {
      const Workload w =
          cube_workload(std::round(random.log_uniform(1e2, 1e7)), std::round(random.log_uniform(1e2, 1e7)),
                        random.log_uniform(1e-4, 0.2), 2, run % 2 == 0 ? 2 : 3);
      const UnitCosts costs = random_costs(random);
      const int best = best_octree_depth(w, costs, {.most_depth = 12});
      for (int depth = 1; depth <= 12; ++depth)
        REQUIRE(octree_time(w, best, costs) <= octree_time(w, depth, costs) * (1 + 1e-12));
    }
  }

  TEST_CASE("no grid of a cube is faster than the best by more than a thousandth; of a flat box by a hundredth") {
    support::RandomNumbers random(5);
    for (int run = 0; run < 40; ++run) {
      Workload w = cube_workload(std::round(random.log_uniform(1e2, 1e7)), std::round(random.log_uniform(1e2, 1e7)),
                                 random.log_uniform(1e-3, 0.2), 2, run % 2 == 0 ? 2 : 3);
      const bool flat = run % 4 > 1;
      if (flat) w.box = {2, 1.3, 0.2};
      const UnitCosts costs = random_costs(random);
      const double found = grid_time(w, best_grid_cells(w, costs), costs);
      double least = found;
      for (int cells = 1; cells <= 600; ++cells)
        if (grid_counts(w, {cells}).references <= 1e9) least = std::min(least, grid_time(w, cells, costs));
      CAPTURE(run);
      CHECK(found <= least * (flat ? 1.01 : 1.001));
    }
  }

  TEST_CASE("no grid in steps of 10 % within the limits is faster, however flat the box") {
    support::RandomNumbers random(6);
    for (int run = 0; run < 60; ++run) {
      Workload w = cube_workload(std::round(random.log_uniform(1e2, 1e7)), std::round(random.log_uniform(1e2, 1e7)),
                                 random.log_uniform(1e-4, 0.2), 2, run % 2 == 0 ? 2 : 3);
      w.box = {2, 2 * random.log_uniform(1e-3, 1), 2 * random.log_uniform(1e-3, 1)};
      const UnitCosts costs = random_costs(random);
      const double found = grid_time(w, best_grid_cells(w, costs), costs);
      CAPTURE(run);
      for (int cells = 1; cells <= 1 << 16 && index_cells(w, cells).count() <= 1 << 26;
           cells = std::max(cells + 1, static_cast<int>(1.1 * cells)))
        if (grid_counts(w, {cells}).references <= 1e9) CHECK(found <= grid_time(w, cells, costs));
    }
  }

  TEST_CASE("each prediction of a technique with numbers has a search for the best ones and a check of its range") {
    for (const Technique technique : all_techniques) {
      const TechniqueModel& model = model_of(technique);
      CAPTURE(name(technique));
      const bool has_numbers = std::ranges::any_of(
          record_of(technique).parameters, [](const Parameter& parameter) { return parameter.choices.empty(); });
      CHECK((model.best != nullptr) == (has_closed_form(technique) && has_numbers));
      CHECK((model.uncounted != nullptr) == (has_closed_form(technique) && has_numbers));
    }
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("expensive discs need small cells, expensive steps large ones, and one ray the largest") {
    CHECK(best_octree_depth(in_cube, UnitCosts{.index_test = 1, .node = 1e-9}) >
          best_octree_depth(in_cube, UnitCosts{.index_test = 1}));
    CHECK(best_octree_depth(in_cube, UnitCosts{.index_test = 1e-9, .node = 1}) == 1);
    CHECK(best_grid_cells(in_cube, UnitCosts{.index_test = 1e-9, .step = 1}) == 1);
    Workload one = in_cube;
    one.rays = 1;
    CHECK(best_octree_depth(one, UnitCosts{.placement = 100}) == 1);
    CHECK(best_grid_cells(one, UnitCosts{.placement = 100}) == 1);
  }

  TEST_CASE("with tiny discs and no other limit, w n_P/m² + v m is smallest at m = (2 w n_P/v)^(1/3)") {
    const Workload w = cube_workload(1e6, 4e6, 1e-9, 2);
    CHECK(best_grid_cells(w, {}) == 200);
    CHECK(best_grid_cells(w, UnitCosts{.index_test = 8}) == 400);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("numbers out of range are refused by name") {
    CHECK_THROWS_WITH_AS((void)best_octree_depth(in_cube, {}, {.most_depth = -1}), Contains("depth"),
                         std::invalid_argument);
    Workload bad = in_cube;
    bad.rays = 0;
    CHECK_THROWS_WITH_AS((void)best_octree_depth(bad, {}), Contains("number of rays"), std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)best_grid_cells(bad, {}), Contains("number of rays"), std::invalid_argument);
  }
}
