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
  double placement = 0;   ///< b: inserting one disc into one cell, node or leaf while an index is built
  double make = 0;        ///< g: making one node of a tree of boxes or spheres
  double sort = 0;        ///< s: sorting one disc along the curve
  double cull = 0;        ///< r: fixed cost of one list, not including its tests and rays
  double visit = 0;       ///< l: fixed cost of one disc's visit to a list, not including its tests
  double hit = 0;         ///< h: recording one hit
  double ray = 0;         ///< i: bringing one ray into a search
  double ends = 0;        ///< e: what the ends of rays add to a test against a sphere, a box or a disc
  double far = 0;         ///< m: handling one disc that no near cache holds (far_discs)
  double streamed = 0;    ///< y: one byte of a ray that no near cache holds (streamed_bytes)
  double touch = 0;       ///< z: one byte of memory that is touched for the first time
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
  double touch = 0;      ///< touching memory for the first time

  /// Of a first search.
  [[nodiscard]] constexpr double total() const { return again() + touch; }
  /// Of a search that is repeated, in the memory of the first one.
  [[nodiscard]] constexpr double again() const { return start + order + build + rebuild + copy + traverse + intersect; }
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

/// Bytes that stay near: those of a usual second-level cache.
inline constexpr double near_bytes = 1.25e6;
/// Of a disc in an index that is built and searched: itself in floats, its place in the order, its sums.
inline constexpr double bytes_of_disc = 125;
/// Of a ray in a list, in floats.
inline constexpr double bytes_of_listed_ray = 20;
/// Of a ray as it is given, and of its copies in a block.
inline constexpr double bytes_of_ray = 128;

/// Doublings from near_bytes to the bytes of the discs that were searched; 0 if they stay near.
[[nodiscard]] inline double far_doublings(const Counts<double>& counts) {
  double discs = std::max({counts.placements, counts.sorted, counts.references});
  if (discs == 0) discs = counts.loaded > 0 ? counts.disc_tests / counts.loaded : counts.visits;  // brute force
  return std::log2(std::max(1.0, discs * bytes_of_disc / near_bytes));
}

/// The discs that are sorted, placed or visited (the largest of the three numbers), times the square of far_doublings: discs are met in
/// random order, and a second doubling takes more of them farther away than the first, from cache to cache and to the memory.
[[nodiscard]] inline double far_discs(const Counts<double>& counts) {
  return std::max({counts.placements, counts.sorted, counts.visits}) * std::pow(far_doublings(counts), 2);
}

/// The lists made, each times 1 + 2 far_doublings: to make a list is to go to a node of the index, and to a list of another size. Measured
/// with costs fitted to synthetic discs and lines, on box trees over six meshes of 22 000 to 252 000 vertices and 10³ to 10⁶ pieces of paths
/// (right counts): with 1 alone, seconds of the search are off by a factor of 2.8 (95 %), with this by 1.8.
[[nodiscard]] inline double far_lists(const Counts<double>& counts) {
  return counts.culls * (1 + 2 * far_doublings(counts));
}

/// Tests of rays that are searched as segments. Measured on box trees and sphere caches, the ends add about the same to a
/// test against a sphere, a box and a disc.
[[nodiscard]] inline double tests_of_ends(const Counts<double>& counts) {
  return counts.loaded > 0 ? counts.segments / counts.loaded * tests(counts) : 0;
}

/// The number of tests of rays in lists of more than near_bytes. Derived from other counts: each level of a hierarchy makes about as many
/// tests, and lists shrink by about the same factor from level to level, from a block of rays to the mean list.
[[nodiscard]] inline double long_tests(const Counts<double>& counts) {
  constexpr double near_rays = near_bytes / bytes_of_listed_ray;
  const double discs = std::max({counts.placements, counts.sorted, counts.references});
  const double block = ray_blocks(counts.loaded, discs, Engine::simd).size;
  if (!(block > near_rays && counts.culls > 0)) return 0;
  const double mean = std::clamp(counts.cull_tests / counts.culls, 1.0, near_rays);
  return counts.cull_tests * std::log(block / near_rays) / std::log(block / mean);
}

/// Bytes of rays that are read or written one after another and do not stay near: those of long lists, and of rays given beyond
/// cached_rays.
[[nodiscard]] inline double streamed_bytes(const Counts<double>& counts) {
  constexpr double cached_rays = 0x1p17;  // stay in the last-level cache from their making to their search
  return bytes_of_listed_ray * long_tests(counts) + bytes_of_ray * std::max(0.0, counts.loaded - cached_rays);
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
    UnitCostTerm{"b", &UnitCosts::placement, quantity_of<&Counts<double>::placements>, CostEngine::both,
                 &CostBreakdown::build, "placing a disc in a cell, node or leaf while an index is built"},
    UnitCostTerm{"g", &UnitCosts::make, quantity_of<&Counts<double>::made>, CostEngine::lists, &CostBreakdown::build,
                 "making a node of a tree of boxes or spheres"},
    UnitCostTerm{"s", &UnitCosts::sort, quantity_of<&Counts<double>::sorted>, CostEngine::both, &CostBreakdown::order,
                 "sorting a disc along the curve"},
    UnitCostTerm{"r", &UnitCosts::cull, far_lists, CostEngine::both, &CostBreakdown::rebuild,
                 "making a list, beside its tests and rays; with many discs, several times"},
    UnitCostTerm{"l", &UnitCosts::visit, quantity_of<&Counts<double>::visits>, CostEngine::both,
                 &CostBreakdown::intersect, "a disc's visit to a list, beside its tests"},
    UnitCostTerm{"h", &UnitCosts::hit, quantity_of<&Counts<double>::hits>, CostEngine::both, &CostBreakdown::intersect,
                 "recording a hit"},
    UnitCostTerm{"i", &UnitCosts::ray, quantity_of<&Counts<double>::loaded>, CostEngine::both, &CostBreakdown::start,
                 "bringing a ray into a search"},
    UnitCostTerm{"e", &UnitCosts::ends, tests_of_ends, CostEngine::both, &CostBreakdown::intersect,
                 "the ends of a ray in a test, if some rays end"},
    UnitCostTerm{"m", &UnitCosts::far, far_discs, CostEngine::both, &CostBreakdown::build,
                 "handling a disc of more than 10 000, times the square of their doublings beyond"},
    UnitCostTerm{"y", &UnitCosts::streamed, streamed_bytes, CostEngine::both, &CostBreakdown::start,
                 "a byte of rays that no near cache holds"},
    UnitCostTerm{"z", &UnitCosts::touch, quantity_of<&Counts<double>::bytes_touched>, CostEngine::both,
                 &CostBreakdown::touch, "touching a byte of memory for the first time"},
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
