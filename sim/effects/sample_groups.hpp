#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "sampled_tree.hpp"

namespace detp::sim {

/// A ray in the unit of the sample. Its origin is the ray's nearest point to that of the sample, because floats are coarse
/// far from it.
struct LocalRay {
  std::array<float, 3> origin;
  std::array<float, 3> direction;
  float from;
  float to;

  LocalRay(const Ray& ray, const glm::dvec3& centre, double unit);

  [[nodiscard]] float squared_distance(float x, float y, float z) const {
    const float a = x - origin[0];
    const float b = y - origin[1];
    const float c = z - origin[2];
    const float place = a * direction[0] + b * direction[1] + c * direction[2];
    const float behind = place < from ? from : place;
    const float nearest = behind < to ? behind : to;
    const float p = a - nearest * direction[0];
    const float q = b - nearest * direction[1];
    const float r = c - nearest * direction[2];
    return p * p + q * q + r * r;
  }
};

/// Points, 16 of which are tested at once.
class PointBlocks {
 public:
  static constexpr std::size_t size = 16;
  using Distances = std::array<float, size>;

  void add(const glm::vec3& point) {
    for (int axis = 0; axis < 3; ++axis) along_[static_cast<std::size_t>(axis)].push_back(point[axis]);
  }
  /// Squared distances of `size` points from the ray. There must be as many after the first.
  [[nodiscard]] Distances squared_distances(const LocalRay& ray, std::size_t first) const {
    const float* const x = &along_[0][first];
    const float* const y = &along_[1][first];
    const float* const z = &along_[2][first];
    Distances squared;
    for (std::size_t i = 0; i < size; ++i) squared[i] = ray.squared_distance(x[i], y[i], z[i]);
    return squared;
  }

 private:
  std::array<std::vector<float>, 3> along_;
};

/// Every `step`-th of the sampled discs, in groups of at most 32 neighbours on the curve, and these in blocks of 16, to
/// find those near a ray. In floats: a disc just as far from the ray as the reach may be counted or not.
class SampleGroups {
 public:
  SampleGroups(const CurveSample& sample, const std::vector<SampledNode>& tree, std::uint32_t step, double around,
               double near);

  /// Calls visit(place) for the discs whose centres lie at most `near` from the ray, with their places on the curve.
  /// Returns how many lie at most `around` from it. A group that is small against this reach counts as a whole.
  template <class Visit>
  std::uint32_t visit_near(const Ray& ray, const Visit& visit) const {
    const LocalRay local(ray, centre_, unit_);
    std::uint32_t around = 0;
    for (std::size_t first = 0; first < blocks_.size(); first += size) {
      const auto squared = block_middles_.squared_distances(local, first);
      for (std::size_t i = 0; i < size; ++i)
        if (squared[i] <= blocks_[first + i]) around += visit_block(local, first + i, visit);
    }
    return around;
  }

 private:
  static constexpr std::size_t size = PointBlocks::size;
  static constexpr std::uint32_t most_in_group = 2 * size;

  template <class Visit>
  std::uint32_t visit_block(const LocalRay& ray, std::size_t block, const Visit& visit) const {
    const std::size_t first = block * size;
    const auto squared = group_middles_.squared_distances(ray, first);
    const std::uint32_t* const whole = &whole_[first];
    const float* const limit = &limit_[first];
    const float reach = squared_around_;
    std::array<std::uint32_t, size> is_open;
    std::uint32_t around = 0;
    std::uint32_t any_open = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::uint32_t is_around = squared[i] <= reach ? ~0U : 0U;
      is_open[i] = squared[i] <= limit[i] ? ~0U : 0U;
      around += whole[i] & is_around;
      any_open |= is_open[i];
    }
    if (any_open == 0) return around;
    for (std::size_t i = 0; i < size; ++i)
      if (is_open[i] != 0) around += visit_discs(ray, groups_[first + i], whole[i] == 0, visit);
    return around;
  }

  struct Group {
    std::uint32_t first = 0;
    std::uint32_t size = 0;
  };

  template <class Visit>
  std::uint32_t visit_discs(const LocalRay& ray, const Group& group, bool counts_each, const Visit& visit) const {
    std::uint32_t around = 0;
    for (std::uint32_t first = 0; first < group.size; first += size) {
      const auto squared = centres_.squared_distances(ray, group.first + first);
      const std::uint32_t count = std::min<std::uint32_t>(size, group.size - first);
      for (std::uint32_t i = 0; i < count; ++i) {
        if (squared[i] <= squared_near_) visit((group.first + first + i) * step_);
        if (counts_each && squared[i] <= squared_around_) around += 1;
      }
    }
    return around;
  }

  /// The number of every `step`-th discs before this place.
  [[nodiscard]] std::uint32_t kept_before(std::uint32_t place) const { return (place + step_ - 1) / step_; }
  void add(const SampledNode& node, float around, float near);
  void add_blocks(const std::vector<SampledNode>& groups, float reach);

  glm::dvec3 centre_;
  double unit_;
  std::uint32_t step_;
  float squared_around_;
  float squared_near_;
  PointBlocks centres_;  ///< of the discs
  std::vector<Group> groups_;
  PointBlocks group_middles_;
  std::vector<std::uint32_t> whole_;  ///< number of discs, if the group counts as a whole, else 0
  std::vector<float> limit_;          ///< of the squared distance of the middle, up to which discs are looked at
  PointBlocks block_middles_;
  std::vector<float> blocks_;  ///< limits of the blocks
};

}  // namespace detp::sim
