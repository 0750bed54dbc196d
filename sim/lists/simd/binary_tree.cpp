#include "binary_tree.hpp"

#include <bit>

namespace detp::sim::stream {
namespace {

void make_leaf(const SortedDiscs& discs, BinaryNode& node) {
  node.box = box_around(std::span(discs.tree.discs).subspan(node.first, node.count));
  node.cost = static_cast<float>(node.count) * node.box.area();
}

}  // namespace

std::uint32_t boundary(std::span<const CurvePlace> places, std::uint32_t first, std::uint32_t count) {
  const std::uint32_t low = place_code(places[first]);
  const std::uint32_t high = place_code(places[first + count - 1]);
  if (low == high) return first + count / 2;
  const std::uint32_t start = high & ~(std::bit_floor(low ^ high) - 1);
  const auto below = [start](CurvePlace place) { return place_code(place) < start; };
  // The boundary is mostly near the middle. Steps that double from there touch fewer cache lines than halving the run.
  auto from = places.begin() + first;
  auto to = from + count;
  const auto middle = from + count / 2;
  if (below(*middle)) {
    std::ptrdiff_t step = 1;
    for (from = middle; step < to - from && below(from[step]); step *= 2) from += step;
    to = std::min(to, from + step);
  } else {
    std::ptrdiff_t step = 1;
    for (to = middle; step < to - from && !below(to[-step]); step *= 2) to -= step;
    from = std::max(from, to - step);
  }
  return static_cast<std::uint32_t>(std::partition_point(from, to, below) - places.begin());
}

void join(BinaryNode& node, const BinaryNode& left, const BinaryNode& right, std::uint32_t right_number) {
  const FloatBox box = joined(left.box, right.box);
  node.box = box;
  const NodeCost cost(box.area(), node.count, left.box.area() + right.box.area(), left.cost + right.cost);
  node.cost = cost.cost;
  node.right = cost.inner ? right_number : 0;
}

std::uint32_t split_run(const SortedDiscs& discs, std::uint32_t leaf, std::uint32_t first, std::uint32_t count,
                        BinaryNode* nodes, std::uint32_t number) {
  nodes[number] = {.box = nothing, .first = first, .count = count, .right = 0, .cost = 0};
  if (count <= leaf) {
    make_leaf(discs, nodes[number]);
    return number + 1;
  }
  const std::uint32_t middle = boundary(*discs.places, first, count);
  const std::uint32_t right = split_run(discs, leaf, first, middle - first, nodes, number + 1);
  const std::uint32_t end = split_run(discs, leaf, middle, first + count - middle, nodes, right);
  join(nodes[number], nodes[number + 1], nodes[right], right);
  return nodes[number].leaf() ? number + 1 : end;
}

}  // namespace detp::sim::stream
