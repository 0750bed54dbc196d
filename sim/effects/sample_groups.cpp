#include "sample_groups.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace detp::sim {
namespace {

constexpr float nothing = -1;  // a limit that no squared distance keeps
constexpr float small = 0.5;   // radius of a group that counts as a whole, over the reach

glm::vec3 middle_of(const SampledNode& node) { return 0.5F * (node.low + node.high); }

float radius_of(const SampledNode& node) { return 0.5F * glm::length(node.high - node.low); }

float squared(float value) { return value * value; }

}  // namespace

LocalRay::LocalRay(const Ray& ray, const glm::dvec3& centre, double unit) {
  const double nearest = glm::dot(centre - ray.origin, ray.direction);
  const double start = ray.is_line() ? nearest : std::clamp(nearest, 0.0, ray.length);
  const glm::dvec3 at = (ray.origin + start * ray.direction - centre) / unit;
  for (int axis = 0; axis < 3; ++axis) {
    origin[static_cast<std::size_t>(axis)] = static_cast<float>(at[axis]);
    direction[static_cast<std::size_t>(axis)] = static_cast<float>(ray.direction[axis]);
  }
  from = ray.is_line() ? -HUGE_VALF : static_cast<float>(-start / unit);
  to = static_cast<float>((ray.length - start) / unit);
}

SampleGroups::SampleGroups(const CurveSample& sample, const std::vector<SampledNode>& tree, std::uint32_t step,
                           double around, double near)
    : centre_(sample.origin), unit_(sample.unit), step_(step) {
  const auto local_around = static_cast<float>(around / unit_);
  const auto local_near = static_cast<float>(near / unit_);
  squared_around_ = squared(local_around);
  squared_near_ = squared(local_near);
  near_limits_.fill(squared_near_);
  for (std::size_t i = 0; i < sample.discs.size(); i += step) centres_.add(sample.discs[i].centre);
  for (std::size_t i = 0; i < size; ++i) centres_.add(glm::vec3(0));
  std::vector<SampledNode> groups;
  for (std::uint32_t i = 0; i < tree.size();) {
    const std::uint32_t kept = kept_before(tree[i].end) - kept_before(tree[i].first);
    const bool is_group = kept <= most_in_group;
    if (is_group && kept > 0) groups.push_back(tree[i]);
    i = is_group ? tree[i].next : i + 1;
  }
  for (const SampledNode& group : groups) add(group, local_around, local_near);
  add_blocks(groups, std::max(local_around, local_near));
}

void SampleGroups::add(const SampledNode& node, float around, float near) {
  const float radius = radius_of(node);
  const bool whole = radius <= small * around;
  const std::uint32_t first = kept_before(node.first);
  const std::uint32_t kept = kept_before(node.end) - first;
  groups_.push_back({first, kept});
  group_middles_.add(middle_of(node));
  whole_.push_back(whole ? kept : 0);
  limit_.push_back(squared(radius + (whole ? near : std::max(near, around))));
}

void SampleGroups::add_blocks(const std::vector<SampledNode>& groups, float reach) {
  for (std::size_t first = 0; first < groups.size(); first += size) {
    SampledNode block = groups[first];
    for (std::size_t i = first; i < std::min(first + size, groups.size()); ++i) {
      block.low = glm::min(block.low, groups[i].low);
      block.high = glm::max(block.high, groups[i].high);
    }
    block_middles_.add(middle_of(block));
    blocks_.push_back(squared(radius_of(block) + reach));
  }
  while (blocks_.size() % size != 0) {
    block_middles_.add(glm::vec3(0));
    blocks_.push_back(nothing);
  }
  while (limit_.size() % size != 0) {
    groups_.push_back({});
    group_middles_.add(glm::vec3(0));
    whole_.push_back(0);
    limit_.push_back(nothing);
  }
}

}  // namespace detp::sim
