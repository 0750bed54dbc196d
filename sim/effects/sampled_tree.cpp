#include "sampled_tree.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>

namespace detp::sim {
namespace {

/// Where the second half of the discs from `first` up to `end` begins.
std::uint32_t first_of_second_half(const std::vector<std::uint64_t>& keys, std::uint32_t first, std::uint32_t end) {
  const std::uint64_t last = keys[end - 1];
  const std::uint64_t differ = keys[first] ^ last;
  if (differ == 0) return first + (end - first) / 2;
  const std::uint64_t start = last & ~(std::bit_floor(differ) - 1);
  return static_cast<std::uint32_t>(std::lower_bound(keys.begin() + first, keys.begin() + end, start) - keys.begin());
}

/// Four floats, of which three are used: the compiler compares them at once.
using Four = std::array<float, 4>;

void lower(Four& least, const Four& value) {
  for (std::size_t i = 0; i < 4; ++i) least[i] = value[i] < least[i] ? value[i] : least[i];
}

SampledNode node_around(const CurveSample& sample, std::uint32_t first, std::uint32_t end) {
  Four low;
  low.fill(HUGE_VALF);
  Four minus_high = low;
  Four flattest = low;
  for (std::uint32_t i = first; i < end; ++i) {
    const SampledDisc& disc = sample.discs[i];
    lower(low, {disc.centre.x, disc.centre.y, disc.centre.z, 0});
    lower(minus_high, {-disc.centre.x, -disc.centre.y, -disc.centre.z, 0});
    lower(flattest, {disc.steepness.x, disc.steepness.y, disc.steepness.z, 0});
  }
  return {.low = {low[0], low[1], low[2]},
          .high = {-minus_high[0], -minus_high[1], -minus_high[2]},
          .flattest = {flattest[0], flattest[1], flattest[2]},
          .first = first,
          .end = end};
}

void add_node(std::vector<SampledNode>& nodes, const CurveSample& sample, std::uint32_t first, std::uint32_t end) {
  const std::size_t number = nodes.size();
  if (end - first < least_split) {
    nodes.push_back(node_around(sample, first, end));
  } else {
    nodes.push_back({.first = first, .end = end});
    const std::uint32_t middle = first_of_second_half(sample.keys, first, end);
    add_node(nodes, sample, first, middle);
    const std::size_t second = nodes.size();
    add_node(nodes, sample, middle, end);
    const SampledNode& a = nodes[number + 1];
    const SampledNode& b = nodes[second];
    SampledNode& node = nodes[number];
    node.low = glm::min(a.low, b.low);
    node.high = glm::max(a.high, b.high);
    node.flattest = glm::min(a.flattest, b.flattest);
  }
  nodes[number].next = static_cast<std::uint32_t>(nodes.size());
}

}  // namespace

std::vector<SampledNode> sampled_tree(const CurveSample& sample) {
  std::vector<SampledNode> nodes;
  nodes.reserve(sample.discs.size() / 2 + 1);
  add_node(nodes, sample, 0, static_cast<std::uint32_t>(sample.discs.size()));
  return nodes;
}

}  // namespace detp::sim
