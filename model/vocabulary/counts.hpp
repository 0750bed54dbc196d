#pragma once

#include <string_view>

#include "technique.hpp"

/// What a technique does, counted: the same record for a prediction (double, an expectation) and for an observation
/// (std::uint64_t), so that comparing the two is a subtraction term by term.
namespace detp {

template <class T>
struct Counts {
  T sphere_tests{};  ///< ray-sphere tests
  T disc_tests{};    ///< ray-disc tests
  T steps{};         ///< cells of a grid visited by a ray
  T nodes{};         ///< nodes of a tree, inner ones and leaves, visited by a ray
  T copies{};        ///< rays copied into a sphere's list
  T rebuilds{};      ///< spheres built or rebuilt, the outermost not counted
  T references{};    ///< disc references stored in an index
  T placements{};    ///< discs found to overlap a cell or node while an index is built, at all its levels
  T sorted{};        ///< samples sorted along a curve
  T hits{};          ///< (ray, disc) pairs found

  bool operator==(const Counts&) const = default;

  constexpr Counts& operator+=(const Counts& more) {
    sphere_tests += more.sphere_tests;
    disc_tests += more.disc_tests;
    steps += more.steps;
    nodes += more.nodes;
    copies += more.copies;
    rebuilds += more.rebuilds;
    references += more.references;
    placements += more.placements;
    sorted += more.sorted;
    hits += more.hits;
    return *this;
  }
};

/// Calls visit(name, term) for each term, in the order in which results list them.
template <class C, class Visit>
constexpr void for_each_term(C&& counts, Visit&& visit) {
  visit(std::string_view{"sphere_tests"}, counts.sphere_tests);
  visit(std::string_view{"disc_tests"}, counts.disc_tests);
  visit(std::string_view{"steps"}, counts.steps);
  visit(std::string_view{"nodes"}, counts.nodes);
  visit(std::string_view{"copies"}, counts.copies);
  visit(std::string_view{"rebuilds"}, counts.rebuilds);
  visit(std::string_view{"references"}, counts.references);
  visit(std::string_view{"placements"}, counts.placements);
  visit(std::string_view{"sorted"}, counts.sorted);
  visit(std::string_view{"hits"}, counts.hits);
}

/// Ray-sphere and ray-disc tests together: the one number that compares techniques without a clock.
template <class T>
[[nodiscard]] constexpr T tests(const Counts<T>& counts) {
  return counts.sphere_tests + counts.disc_tests;
}

/// Time in seconds of each counted operation, on one machine. All from 0 to 1e200.
///
/// The paper has t, u and (implicitly) v; the others are what its formulas leave out (science erratum: sort, copies).
struct UnitCosts {
  double sphere_test = 1;  ///< t: one ray of a list against a sphere or a box
  double disc_test = 1;    ///< u: one ray of a list against a disc
  double index_test = 1;   ///< w: one ray against a disc of a cell it is in, of a technique that searches_an_index
  double step = 1;         ///< v: one step to a cell of a grid
  double node = 1;         ///< v: one visit to a node of a tree
  double copy = 0;         ///< c: copying one kept ray into a list
  double placement = 0;    ///< b: placing one disc in one cell or node while an index is built
  double sort = 0;         ///< s: ordering one sample along the curve, code and sort
  double rebuild = 0;      ///< fixed cost of one sphere rebuild, beside its tests and copies

  bool operator==(const UnitCosts&) const = default;
};

/// Throws std::invalid_argument, naming the time, where one is negative, above 1e200 or no number.
void check(const UnitCosts& costs);

/// The time of a technique by part, in the unit of the UnitCosts it was made with.
struct CostBreakdown {
  double order = 0;      ///< sorting the samples
  double build = 0;      ///< building an index
  double rebuild = 0;    ///< T_R: ray-sphere tests of all rebuilds
  double copy = 0;       ///< list copies of all rebuilds
  double traverse = 0;   ///< steps through an index
  double intersect = 0;  ///< T_I: ray-disc tests

  [[nodiscard]] constexpr double total() const { return order + build + rebuild + copy + traverse + intersect; }
};

/// Counts × unit costs, part by part, of a technique that tests lists of rays.
[[nodiscard]] constexpr CostBreakdown price(const Counts<double>& counts, const UnitCosts& costs) {
  return {.order = counts.sorted * costs.sort,
          .build = counts.placements * costs.placement,
          .rebuild = counts.sphere_tests * costs.sphere_test + counts.rebuilds * costs.rebuild,
          .copy = counts.copies * costs.copy,
          .traverse = counts.steps * costs.step + counts.nodes * costs.node,
          .intersect = counts.disc_tests * costs.disc_test};
}

/// The same of any technique: where it searches_an_index, disc tests cost what they do there.
[[nodiscard]] constexpr CostBreakdown price(const Counts<double>& counts, UnitCosts costs, Technique technique) {
  if (searches_an_index(technique)) costs.disc_test = costs.index_test;
  return price(counts, costs);
}

/// An observation as a prediction's record, for arithmetic.
template <class T>
[[nodiscard]] constexpr Counts<double> as_expected(const Counts<T>& counts) {
  return {.sphere_tests = static_cast<double>(counts.sphere_tests),
          .disc_tests = static_cast<double>(counts.disc_tests),
          .steps = static_cast<double>(counts.steps),
          .nodes = static_cast<double>(counts.nodes),
          .copies = static_cast<double>(counts.copies),
          .rebuilds = static_cast<double>(counts.rebuilds),
          .references = static_cast<double>(counts.references),
          .placements = static_cast<double>(counts.placements),
          .sorted = static_cast<double>(counts.sorted),
          .hits = static_cast<double>(counts.hits)};
}

}  // namespace detp
