#include <algorithm>
#include <cmath>

#include "block_search.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/geometry/curve.hpp"
#include "ray_blocks.hpp"
#include "search.hpp"

namespace detp::sim::stream {
namespace {

double rays_together(const SearchSize& size) {
  return static_cast<double>(std::min(rays_in_block(size.discs), size.rays));
}

/// Floats of a ray in a list.
double floats_per_ray(const SearchSize& size) { return size.segments ? 7 : 5; }

/// Bytes of the block that is searched and, on several threads, of the block that is loaded meanwhile. The pieces of the first are moved together.
double block_bytes(const SearchSize& size) {
  const double list_bytes_a_ray = floats_per_ray(size) * sizeof(float);
  const double bytes_a_ray = list_bytes_a_ray + (size.powers ? sizeof(double) : 0);
  const int threads = thread_count(size.threads);
  const std::size_t block = rays_in_block(size.discs);
  const std::size_t first = std::min(block, size.rays);
  const double moved = 1 - 1 / static_cast<double>(pieces_of_block(first, threads));
  return bytes_a_ray * static_cast<double>(std::min((threads > 1 ? 2 : 1) * block, size.rays)) +
         moved * list_bytes_a_ray * static_cast<double>(first);
}

/// Bytes of the nested lists of one thread.
double list_bytes(const SearchSize& size, const ListCapacity& lists) {
  return sizeof(float) * floats_per_ray(size) * rays_together(size) * lists.all;
}

/// The larger of two peaks: during the search (with the blocks of rays) and after it (with the outcome, no blocks).
double searching_bytes(const SearchSize& size, double tree, double lists) {
  constexpr double outcome = sizeof(std::uint64_t) + sizeof(double);
  const double a_disc = sizeof(FloatDisc) + sizeof(std::uint32_t) + sizeof(ClassCounts) +
                        (size.sums ? sizeof(DiscTotals) : 0) + size.error_bytes;
  const auto discs = static_cast<double>(size.discs);
  return a_disc * discs + tree + lists + std::max(block_bytes(size), size.own_totals ? outcome * discs : 0);
}

}  // namespace

SearchSize size_of(const Problem& problem, const RunOptions& options) {
  return {.discs = problem.discs().size(),
          .rays = problem.rays().size(),
          .threads = options.threads,
          .segments = problem.segments(),
          .sums = !problem.one_power() || options.pairs || problem.front_facing() || options.totals != nullptr ||
                  sums_bytes(problem, options) > 0,
          .powers = needs_powers(problem, options),
          .error_bytes = sums_bytes(problem, options) / static_cast<double>(problem.discs().size()),
          .own_totals = options.totals == nullptr};
}

std::size_t list_rays(const SearchSize& size, const ListCapacity& lists) {
  return static_cast<std::size_t>(rays_together(size) * (1 + lists.all));
}

std::size_t least_list_rays(const SearchSize& size, const ListCapacity& lists) {
  return static_cast<std::size_t>(rays_together(size) * lists.all / 2);
}

double all_bytes(const SearchSize& size) { return searching_bytes(size, 0, 0); }

double walk_bytes(const SearchSize& size, const ListCapacity& lists) {
  return std::max(sorting_bytes(size.discs), searching_bytes(size, 0, list_bytes(size, lists)));
}

double boxes_bytes(const SearchSize& size, const TreeSize& tree) {
  const bool divided = thread_count(size.threads) > 1 && rays_together(size) >= static_cast<double>(rays_to_divide);
  const double lists = (divided ? thread_count(size.threads) : 1) * list_bytes(size, tree.lists);
  return std::max(building_bytes(size.discs, tree.binary_nodes, tree.nodes),
                  searching_bytes(size, sizeof(TreeNode) * tree.nodes, lists));
}

TreeSize expected_tree(std::size_t discs, const BoxTreeParameters& parameters) {
  const double nodes = std::min(2.0, 4.0 / parameters.leaf) * static_cast<double>(discs);
  const double share = std::pow(parameters.fan_out, -2.0 / 3);  // a child's surface relative to its parent's surface
  return {.binary_nodes = nodes, .nodes = nodes, .lists = {share, share + share / (1 - share)}};
}

}  // namespace detp::sim::stream
