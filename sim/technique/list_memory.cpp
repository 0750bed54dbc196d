#include "list_memory.hpp"

#include <algorithm>
#include <cmath>

#include "detp/sim/geometry/curve.hpp"
#include "detp/sim/lists/plain/ray_list.hpp"
#include "detp/sim/lists/simd/ray_list.hpp"
#include "detp/sim/lists/simd/search.hpp"
#include "detp/sim/lists/sphere_walk.hpp"
#include "detp/sim/search/hit_collector.hpp"
#include "detp/sim/search/run_memory.hpp"

namespace detp::sim {
namespace {

/// Bytes of a level, not including its rays: for three walks (one for each class of rays), and for the walk that is
/// copied to make them.
constexpr double bytes_a_level =
    3 * (sizeof(Sphere) + sizeof(stream::RayList) + sizeof(stream::ListArena::Mark) + sizeof(SphereCounts)) +
    sizeof(SphereCounts) + sizeof(Sphere);

}  // namespace

double listing_bytes(const Problem& problem, const RunOptions& options, double nested) {
  const auto discs = static_cast<double>(problem.discs().size());
  const double kept = options.totals == nullptr ? 0 : sizeof(DiscTotals) * discs;
  return sizeof(std::uint32_t) * discs + found_bytes(problem, options) + kept +
         sizeof(ListedRay) * (1 + nested) * static_cast<double>(problem.rays().size());
}

NestedLists lists_of(const Problem& problem, const SphereCacheParameters& parameters) {
  const double levels = SphereWalk::levels(problem, parameters);
  const double share = parameters.ratio * parameters.ratio;
  if (levels < 1) return {};
  return {levels, share * (1 - std::pow(share, levels)) / (1 - share), share, std::pow(share, levels)};
}

NestedLists lists_of(const Problem& problem, const CellSpheresParameters& parameters) {
  Box box;
  double largest = 0;
  for (const Disc& disc : problem.discs()) {
    box.include(disc.centre);
    largest = std::max(largest, disc.radius);
  }
  const glm::dvec3 size = box.size();
  const double side = std::max({size.x, size.y, size.z});
  NestedLists lists{parameters.depth + 1.0};
  for (int level = 1; level <= parameters.depth; ++level) {
    const double radius = std::ldexp(side, -level) * std::sqrt(0.75) + largest;
    lists.last = std::min(1.0, std::pow(radius / problem.enclosing().radius, 2));
    if (level == 1) lists.first = lists.last;
    lists.rays += lists.last;
  }
  return lists;
}

double walk_bytes(const Problem& problem, const RunOptions& options, const NestedLists& lists, bool plain) {
  const double levels = bytes_a_level * lists.levels;
  if (!plain) return levels + stream::walk_bytes(stream::size_of(problem, options), lists.capacity());
  return levels + std::max(sorting_bytes(problem.discs().size()), listing_bytes(problem, options, lists.rays));
}

double building_bytes(const Problem& problem, const SphereTreeParameters& parameters) {
  constexpr double node = sizeof(Sphere) + sizeof(Box);
  const auto discs = static_cast<double>(problem.discs().size());
  return std::max(sorting_bytes(problem.discs().size()),
                  (sizeof(std::uint32_t) + node * (1 + 1.0 / parameters.leaf)) * discs);
}

double searching_bytes(const Problem& problem, const RunOptions& options, const SphereTree& tree) {
  double lists = 0;
  for (const std::vector<Sphere>& level : tree.levels) {
    double largest = 0;
    for (const Sphere& sphere : level) largest = std::max(largest, sphere.radius);
    lists += std::min(1.0, std::pow(largest / problem.enclosing().radius, 2));
  }
  return static_cast<double>(tree.nodes()) * sizeof(Sphere) + listing_bytes(problem, options, lists);
}

}  // namespace detp::sim
