#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "counts.hpp"
#include "ray_blocks.hpp"
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
  double make = 0;        ///< g: making one node of a tree of boxes or spheres
  double sort = 0;        ///< s: sorting one disc along the curve
  double cull = 0;        ///< r: fixed cost of one list, not including its tests and rays
  double visit = 0;       ///< l: fixed cost of one disc's visit to a list, not including its tests
  double hit = 0;         ///< h: recording one hit
  double ray = 0;         ///< i: bringing one ray into a search
  double ends = 0;        ///< e: what the ends of rays add to a test against a sphere, a box or a disc
  double far = 0;         ///< m: handling one disc, for each doubling of their number above near_discs
  double uncached = 0;    ///< o: sorting or placing one disc, for each doubling of their number above cached_discs
  double long_test = 0;   ///< f: what a list that no near cache holds adds to a test of one of its rays
  double far_ray = 0;     ///< y: what a ray that no cache holds adds to bringing it into a search
  double start = 0;       ///< a: fixed cost of a run

  bool operator==(const UnitCosts&) const = default;
};

/// The time of a technique by part, in the unit of the UnitCosts from which it was computed.
struct CostBreakdown {
  double start = 0;      ///< fixed cost of the run, and bringing rays into the search
  double order = 0;      ///< sorting the samples
  double build = 0;      ///< building an index
  double rebuild = 0;    ///< T_R: tests of all lists, and the lists' fixed cost
  double copy = 0;       ///< adding rays to lists
  double traverse = 0;   ///< steps through an index
  double intersect = 0;  ///< T_I: ray-disc tests, the discs' visits to lists, and recording hits

  [[nodiscard]] constexpr double total() const { return start + order + build + rebuild + copy + traverse + intersect; }
};

/// The two ways to search: a list of rays against one disc after another, or one ray and one disc at a time.
enum class CostEngine { lists, ray_by_ray, both };

/// A unit cost: its name in results and on the command line, and the count and engine to which it belongs.
struct UnitCostTerm {
  std::string_view symbol;  ///< "t"
  double UnitCosts::*cost;
  double (*quantity)(const Counts<double>&);  ///< the number of operations: mostly one of the counts
  CostEngine engine;
  double CostBreakdown::*part;
  std::string_view meaning;  ///< operation whose time it is
};

/// The data of up to about this many discs stay in the second-level cache.
inline constexpr double near_discs = 1e4;

/// The number of discs that are sorted, placed or visited (the largest of the three), times the binary logarithm of this
/// number over near_discs: each doubling leaves fewer of them in a cache.
[[nodiscard]] inline double far_discs(const Counts<double>& counts) {
  const double discs = std::max({counts.placements, counts.sorted, counts.visits});
  return discs > near_discs ? discs * std::log2(discs / near_discs) : 0;
}

/// Tests of rays that are searched as segments. Measured on box trees and sphere caches, the ends add about the same to a
/// test against a sphere, a box and a disc.
[[nodiscard]] inline double tests_of_ends(const Counts<double>& counts) {
  return counts.loaded > 0 ? counts.segments / counts.loaded * tests(counts) : 0;
}

/// The data of up to about this many discs stay in the last-level cache.
inline constexpr double cached_discs = 1.2e5;

/// The number of discs that are sorted or placed, times the binary logarithm of this number over cached_discs. Sorting
/// reads the discs in random order, so most reads of many more wait for the memory.
[[nodiscard]] inline double uncached_discs(const Counts<double>& counts) {
  const double discs = std::max(counts.placements, counts.sorted);
  return discs > cached_discs ? discs * std::log2(discs / cached_discs) : 0;
}

/// A list of up to about this many rays stays in the second-level cache.
inline constexpr double near_rays = 0x1p16;
/// Up to about this many rays stay in the last-level cache from their making to their search.
inline constexpr double cached_rays = 0x1p17;

/// The number of tests of rays in lists of more than near_rays rays. Derived from other counts: each level of a hierarchy makes about as many
/// tests, and lists shrink by about the same factor from level to level, from a block of rays to the mean list.
[[nodiscard]] inline double long_tests(const Counts<double>& counts) {
  const double discs = std::max({counts.placements, counts.sorted, counts.references});
  const double block = ray_blocks(counts.loaded, discs, Engine::simd).size;
  if (!(block > near_rays && counts.culls > 0)) return 0;
  const double mean = std::clamp(counts.cull_tests / counts.culls, 1.0, near_rays);
  return counts.cull_tests * std::log(block / near_rays) / std::log(block / mean);
}

/// The rays beyond cached_rays.
[[nodiscard]] inline double far_rays(const Counts<double>& counts) {
  return std::max(0.0, counts.loaded - cached_rays);
}

/// One count, for UnitCostTerm::quantity.
template <auto count>
[[nodiscard]] constexpr double quantity_of(const Counts<double>& counts) {
  return counts.*count;
}

inline constexpr std::array unit_cost_terms{
    UnitCostTerm{"t", &UnitCosts::cull_test, quantity_of<&Counts<double>::cull_tests>, CostEngine::both,
                 &CostBreakdown::rebuild, "testing a ray of a list against a sphere or a box"},
    UnitCostTerm{"u", &UnitCosts::disc_test, quantity_of<&Counts<double>::disc_tests>, CostEngine::lists,
                 &CostBreakdown::intersect, "testing a ray of a list against a disc"},
    UnitCostTerm{"w", &UnitCosts::index_test, quantity_of<&Counts<double>::disc_tests>, CostEngine::ray_by_ray,
                 &CostBreakdown::intersect, "testing one ray against one disc of an index"},
    UnitCostTerm{"v", &UnitCosts::step, quantity_of<&Counts<double>::steps>, CostEngine::both, &CostBreakdown::traverse,
                 "a ray's step to a cell of a grid"},
    UnitCostTerm{"n", &UnitCosts::node, quantity_of<&Counts<double>::nodes>, CostEngine::both, &CostBreakdown::traverse,
                 "a visit to a node of a tree"},
    UnitCostTerm{"c", &UnitCosts::listed, quantity_of<&Counts<double>::listed>, CostEngine::both, &CostBreakdown::copy,
                 "putting a ray into a list"},
    UnitCostTerm{"b", &UnitCosts::placement, quantity_of<&Counts<double>::placements>, CostEngine::ray_by_ray,
                 &CostBreakdown::build, "placing a disc in a cell or node while an index is built"},
    UnitCostTerm{"p", &UnitCosts::leaf, quantity_of<&Counts<double>::placements>, CostEngine::lists,
                 &CostBreakdown::build, "placing a disc in a leaf of a tree that lists are culled down"},
    UnitCostTerm{"g", &UnitCosts::make, quantity_of<&Counts<double>::made>, CostEngine::lists, &CostBreakdown::build,
                 "making a node of a tree of boxes or spheres"},
    UnitCostTerm{"s", &UnitCosts::sort, quantity_of<&Counts<double>::sorted>, CostEngine::both, &CostBreakdown::order,
                 "sorting a disc along the curve"},
    UnitCostTerm{"r", &UnitCosts::cull, quantity_of<&Counts<double>::culls>, CostEngine::both, &CostBreakdown::rebuild,
                 "making a list, beside its tests and rays"},
    UnitCostTerm{"l", &UnitCosts::visit, quantity_of<&Counts<double>::visits>, CostEngine::both,
                 &CostBreakdown::intersect, "a disc's visit to a list, beside its tests"},
    UnitCostTerm{"h", &UnitCosts::hit, quantity_of<&Counts<double>::hits>, CostEngine::both, &CostBreakdown::intersect,
                 "recording a hit"},
    UnitCostTerm{"i", &UnitCosts::ray, quantity_of<&Counts<double>::loaded>, CostEngine::both, &CostBreakdown::start,
                 "bringing a ray into a search"},
    UnitCostTerm{"e", &UnitCosts::ends, tests_of_ends, CostEngine::both, &CostBreakdown::intersect,
                 "the ends of a ray in a test, if some rays end"},
    UnitCostTerm{"m", &UnitCosts::far, far_discs, CostEngine::both, &CostBreakdown::build,
                 "handling a disc, for each doubling of the number of discs above 10 000"},
    UnitCostTerm{"o", &UnitCosts::uncached, uncached_discs, CostEngine::both, &CostBreakdown::build,
                 "sorting or placing a disc, for each doubling of the number of discs above 120 000"},
    UnitCostTerm{"f", &UnitCosts::long_test, long_tests, CostEngine::lists, &CostBreakdown::rebuild,
                 "what a list of more than 65 536 rays adds to a test"},
    UnitCostTerm{"y", &UnitCosts::far_ray, far_rays, CostEngine::both, &CostBreakdown::start,
                 "what each ray beyond 131 072 adds to bringing it into a search"},
    UnitCostTerm{"a", &UnitCosts::start, [](const Counts<double>&) { return 1.0; }, CostEngine::both,
                 &CostBreakdown::start, "a run, whatever it does"},
};

/// Throws std::invalid_argument if a cost is negative, above 1e200 or NaN. The message names the cost.
void check(const UnitCosts& costs);

/// The time of each part: its counts × their unit costs, with the costs of one engine.
[[nodiscard]] inline CostBreakdown price(const Counts<double>& counts, const UnitCosts& costs,
                                         CostEngine engine = CostEngine::lists) {
  CostBreakdown time;
  for (const UnitCostTerm& term : unit_cost_terms)
    if (term.engine == CostEngine::both || term.engine == engine)
      time.*term.part += term.quantity(counts) * costs.*term.cost;
  return time;
}

/// The same with the costs of the technique's engine.
[[nodiscard]] inline CostBreakdown price(const Counts<double>& counts, const UnitCosts& costs, Technique technique) {
  return price(counts, costs, record_of(technique).ray_by_ray ? CostEngine::ray_by_ray : CostEngine::lists);
}

}  // namespace detp
