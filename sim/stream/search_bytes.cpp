#include <algorithm>

#include "block_search.hpp"
#include "curve_sort.hpp"
#include "detp/sim/radix_sort.hpp"
#include "detp/sim/threads.hpp"
#include "ray_blocks.hpp"
#include "search.hpp"

namespace detp::sim::stream {
namespace {

constexpr double bytes_a_ray = 7 * sizeof(float);

double rays_in_block(const SearchSize& size) {
  return static_cast<double>(std::min(block_size(size.discs), size.rays));
}

/// The block that is searched, and the one that is loaded meanwhile.
double block_bytes(const SearchSize& size) {
  return bytes_a_ray * static_cast<double>(std::min(2 * block_size(size.discs), size.rays));
}

/// A disc in order, its counts, its sums twice (in this order, then in the problem's), its share of the outcome; of
/// several blocks the copy that is kept for a stopped run.
double bytes_a_disc(const SearchSize& size) {
  constexpr double in_order = sizeof(FloatDisc) + sizeof(std::uint32_t);
  constexpr double outcome = sizeof(std::uint64_t) + sizeof(double);
  const double kept =
      size.rays > block_size(size.discs) ? sizeof(ClassCounts) + (size.sums ? sizeof(DiscTotals) : 0) : 0;
  return in_order + sizeof(ClassCounts) + (size.sums ? 2 * sizeof(DiscTotals) : 0) + (size.own_totals ? outcome : 0) +
         kept;
}

}  // namespace

SearchSize size_of(const Problem& problem, const RunOptions& options) {
  return {.discs = problem.discs.size(),
          .rays = problem.rays.size(),
          .threads = options.threads,
          .sums = !problem.one_power || options.pairs || problem.front_facing || options.totals != nullptr,
          .own_totals = options.totals == nullptr};
}

double all_bytes(const SearchSize& size) {
  return bytes_a_disc(size) * static_cast<double>(size.discs) + block_bytes(size);
}

double walk_bytes(const SearchSize& size, double nested) {
  constexpr double sorting = sizeof(glm::dvec3) + 2 * sizeof(KeyedIndex) + sizeof(std::uint32_t);
  const auto discs = static_cast<double>(size.discs);
  constexpr double kept = sizeof(KeyedIndex);  // of sorting, by the heap
  return std::max(sorting * discs, kept * discs + all_bytes(size) + bytes_a_ray * rays_in_block(size) * nested);
}

double boxes_bytes(const SearchSize& size, int fan_out, double nodes) {
  constexpr double in_order = sizeof(FloatDisc) + sizeof(std::uint32_t) + sizeof(CurvePlace);
  constexpr double nested = 0.75;  // measured: rays in a thread's lists, over the outermost
  const double work = rays_in_block(size) * fan_out;
  const double workers = work < static_cast<double>(least_work) ? 1 : thread_count(size.threads);
  const auto discs = static_cast<double>(size.discs);
  // Halves of the tree are copied into one, and hold nodes at first that do not pay: measured, 3.5 times its nodes.
  const double building = in_order * discs + 4 * binary_node_bytes * nodes;
  const double searching = bytes_a_disc(size) * discs + sizeof(TreeNode) * nodes + block_bytes(size) +
                           bytes_a_ray * rays_in_block(size) * nested * (1 + workers);
  return std::max(building, searching);
}

double most_nodes(std::size_t discs, int leaf) { return std::min(2.0, 4.0 / leaf) * static_cast<double>(discs); }

}  // namespace detp::sim::stream
