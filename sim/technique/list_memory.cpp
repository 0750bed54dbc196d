#include "list_memory.hpp"

#include <algorithm>
#include <cmath>

#include "detp/sim/radix_sort.hpp"
#include "detp/sim/stream/ray_list.hpp"
#include "detp/sim/stream/search.hpp"
#include "hit_collector.hpp"
#include "ray_list.hpp"
#include "sphere_walk.hpp"
#include "techniques.hpp"

namespace detp::sim {
namespace {

constexpr double sorting_a_disc = sizeof(glm::dvec3) + 2 * sizeof(KeyedIndex) + sizeof(std::uint32_t);

/// How much larger a level's largest list is than the mean.
constexpr double room = 1.4;

/// What is kept of a level beside its rays, of three walks (one a class of rays).
constexpr double bytes_a_level =
    3 * (sizeof(Sphere) + sizeof(stream::RayList) + sizeof(stream::ListArena::Mark) + sizeof(SphereCounts)) +
    sizeof(SphereCounts);

}  // namespace

NestedLists lists_of(const Problem& problem, const SphereCacheParameters& parameters) {
  const double levels = SphereWalk::levels(problem, parameters);
  const double share = parameters.ratio * parameters.ratio;
  return {levels, room * share * (1 - std::pow(share, levels)) / (1 - share)};
}

NestedLists lists_of(const Problem& problem, const CellSpheresParameters& parameters) {
  Box box;
  double largest = 0;
  for (const Disc& disc : problem.discs) {
    box.include(disc.centre);
    largest = std::max(largest, disc.radius);
  }
  const glm::dvec3 size = box.size();
  const double side = std::max({size.x, size.y, size.z});
  NestedLists lists{parameters.depth + 1.0};
  for (int level = 1; level <= parameters.depth; ++level) {
    const double radius = std::ldexp(side, -level) * std::sqrt(0.75) + largest;
    lists.rays += room * std::min(1.0, std::pow(radius / problem.enclosing.radius, 2));
  }
  return lists;
}

double walk_bytes(const Problem& problem, const RunOptions& options, const NestedLists& lists, bool plain) {
  const double levels = bytes_a_level * lists.levels;
  if (!plain) return levels + stream::walk_bytes(stream::size_of(problem, options), lists.rays);
  const auto discs = static_cast<double>(problem.discs.size());
  const auto rays = static_cast<double>(problem.rays.size());
  const double searching =
      sizeof(std::uint32_t) * discs + found_bytes(problem, options) + sizeof(ListedRay) * (1 + lists.rays) * rays;
  return levels + std::max(sorting_a_disc * discs, searching);
}

double sphere_tree_bytes(const Problem& problem, const RunOptions& options, const SphereTreeParameters& parameters) {
  constexpr double node = sizeof(Sphere) + sizeof(Box);
  constexpr double nested = 5;  // measured: rays in the lists inside the outermost, over its own
  const auto discs = static_cast<double>(problem.discs.size());
  const auto rays = static_cast<double>(problem.rays.size());
  const double above = (1.0 / parameters.leaf) * (1 + 1.0 / (parameters.fan_out - 1));  // nodes a disc
  const double building = sorting_a_disc + node + (node + sizeof(Sphere)) * above;
  return building * discs + found_bytes(problem, options) + sizeof(ListedRay) * (1 + nested) * rays;
}

}  // namespace detp::sim
