#pragma once

#include <array>
#include <string_view>

#include "counts.hpp"
#include "technique.hpp"

namespace detp {

/// Time in seconds of each counted operation on one machine; all from 0 to 1e200.
///
/// The paper has t, u and (implicitly) v. The other costs belong to operations that its formulas omit, such as sorting
/// and copying. unit_cost_terms says to which count and engine each cost belongs.
struct UnitCosts {
  double cull_test = 1;   ///< t: testing one ray of a list against a sphere or a box
  double disc_test = 1;   ///< u: testing one ray of a list against a disc
  double index_test = 1;  ///< w: testing one ray against a disc of a cell, if rays are searched one by one
  double step = 1;        ///< v: one step to a grid cell
  double node = 1;        ///< n: one visit to a tree node
  double listed = 0;      ///< c: adding one ray to a list, not including its test
  double placement = 0;   ///< b: inserting one disc into one cell or node while an index is built
  double leaf = 0;        ///< p: inserting one disc into a leaf of a tree of spheres or boxes
  double sort = 0;        ///< s: sorting one disc along the curve
  double cull = 0;        ///< r: fixed cost of one list, not including its tests and rays
  double visit = 0;       ///< l: fixed cost of one disc's visit to a list, not including its tests

  bool operator==(const UnitCosts&) const = default;
};

/// The time of a technique by part, in the unit of the UnitCosts from which it was computed.
struct CostBreakdown {
  double order = 0;      ///< sorting the samples
  double build = 0;      ///< building an index
  double rebuild = 0;    ///< T_R: tests of all lists, and the lists' fixed cost
  double copy = 0;       ///< adding rays to lists
  double traverse = 0;   ///< steps through an index
  double intersect = 0;  ///< T_I: ray-disc tests, and the discs' visits to lists

  [[nodiscard]] constexpr double total() const { return order + build + rebuild + copy + traverse + intersect; }
};

/// The two ways to search: a list of rays against one disc after another, or one ray and one disc at a time.
enum class CostEngine { lists, ray_by_ray, both };

/// A unit cost: its name in results and on the command line, and the count and engine to which it belongs.
struct UnitCostTerm {
  std::string_view symbol;  ///< "t"
  double UnitCosts::*cost;
  double Counts<double>::*count;
  CostEngine engine;
  double CostBreakdown::*part;
  std::string_view meaning;  ///< operation whose time it is
};

inline constexpr std::array unit_cost_terms{
    UnitCostTerm{"t", &UnitCosts::cull_test, &Counts<double>::cull_tests, CostEngine::both, &CostBreakdown::rebuild,
                 "testing a ray of a list against a sphere or a box"},
    UnitCostTerm{"u", &UnitCosts::disc_test, &Counts<double>::disc_tests, CostEngine::lists, &CostBreakdown::intersect,
                 "testing a ray of a list against a disc"},
    UnitCostTerm{"w", &UnitCosts::index_test, &Counts<double>::disc_tests, CostEngine::ray_by_ray,
                 &CostBreakdown::intersect, "testing one ray against one disc of an index"},
    UnitCostTerm{"v", &UnitCosts::step, &Counts<double>::steps, CostEngine::both, &CostBreakdown::traverse,
                 "a ray's step to a cell of a grid"},
    UnitCostTerm{"n", &UnitCosts::node, &Counts<double>::nodes, CostEngine::both, &CostBreakdown::traverse,
                 "a visit to a node of a tree"},
    UnitCostTerm{"c", &UnitCosts::listed, &Counts<double>::listed, CostEngine::both, &CostBreakdown::copy,
                 "putting a ray into a list"},
    UnitCostTerm{"b", &UnitCosts::placement, &Counts<double>::placements, CostEngine::ray_by_ray, &CostBreakdown::build,
                 "placing a disc in a cell or node while an index is built"},
    UnitCostTerm{"p", &UnitCosts::leaf, &Counts<double>::placements, CostEngine::lists, &CostBreakdown::build,
                 "placing a disc in a leaf of a tree that lists are culled down"},
    UnitCostTerm{"s", &UnitCosts::sort, &Counts<double>::sorted, CostEngine::both, &CostBreakdown::order,
                 "sorting a disc along the curve"},
    UnitCostTerm{"r", &UnitCosts::cull, &Counts<double>::culls, CostEngine::both, &CostBreakdown::rebuild,
                 "making a list, beside its tests and rays"},
    UnitCostTerm{"l", &UnitCosts::visit, &Counts<double>::visits, CostEngine::both, &CostBreakdown::intersect,
                 "a disc's visit to a list, beside its tests"},
};

/// Throws std::invalid_argument if a cost is negative, above 1e200 or NaN. The message names the cost.
void check(const UnitCosts& costs);

/// The time of each part: its counts × their unit costs, with the costs of one engine.
[[nodiscard]] constexpr CostBreakdown price(const Counts<double>& counts, const UnitCosts& costs,
                                            CostEngine engine = CostEngine::lists) {
  CostBreakdown time;
  for (const UnitCostTerm& term : unit_cost_terms)
    if (term.engine == CostEngine::both || term.engine == engine)
      time.*term.part += counts.*term.count * costs.*term.cost;
  return time;
}

/// The same with the costs of the technique's engine.
[[nodiscard]] constexpr CostBreakdown price(const Counts<double>& counts, const UnitCosts& costs, Technique technique) {
  return price(counts, costs, record_of(technique).ray_by_ray ? CostEngine::ray_by_ray : CostEngine::lists);
}

}  // namespace detp
