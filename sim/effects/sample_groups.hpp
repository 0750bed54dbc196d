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

  struct Tested {
    Distances squared;         ///< distances of the points from the ray
    std::uint32_t weight = 0;  ///< sum of the weights of the points at most `reach` away
    std::uint32_t open = 0;    ///< not 0 if a point is within its limit
  };

  void add(const glm::vec3& point) {
    for (int axis = 0; axis < 3; ++axis) along_[static_cast<std::size_t>(axis)].push_back(point[axis]);
  }
  /// Tests `size` points; `reach` and the limits are squared. Without branches, so that the compiler tests four at once.
  [[nodiscard]] Tested test(const LocalRay& ray, std::size_t first, float reach, const std::uint32_t* weights,
                            const float* limits) const {
    const float* const x = &along_[0][first];
    const float* const y = &along_[1][first];
    const float* const z = &along_[2][first];
    Tested tested;
    std::uint32_t weight = 0;
    std::uint32_t open = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const float squared = ray.squared_distance(x[i], y[i], z[i]);
      tested.squared[i] = squared;
      weight += weights[i] & (squared <= reach ? ~0U : 0U);
      open |= squared <= limits[i] ? ~0U : 0U;
    }
    tested.weight = weight;
    tested.open = open;
    return tested;
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
      const auto tested = block_middles_.test(local, first, 0, no_weights.data(), &blocks_[first]);
      if (tested.open == 0) continue;
      for (std::size_t i = 0; i < size; ++i)
        if (tested.squared[i] <= blocks_[first + i]) around += visit_block(local, first + i, visit);
    }
    return around;
  }

 private:
  static constexpr std::size_t size = PointBlocks::size;
  static constexpr std::uint32_t most_in_group = 2 * size;
  using Weights = std::array<std::uint32_t, size>;
  static constexpr Weights no_weights{};
  /// first_ones[n]: 1 for the first n points, else 0.
  static constexpr std::array<Weights, size + 1> first_ones = [] {
    std::array<Weights, size + 1> all{};
    for (std::size_t n = 0; n <= size; ++n)
      for (std::size_t i = 0; i < n; ++i) all[n][i] = 1;
    return all;
  }();

  template <class Visit>
  std::uint32_t visit_block(const LocalRay& ray, std::size_t block, const Visit& visit) const {
    const std::size_t first = block * size;
    const auto tested = group_middles_.test(ray, first, squared_around_, &whole_[first], &limit_[first]);
    std::uint32_t around = tested.weight;
    if (tested.open == 0) return around;
    for (std::size_t i = 0; i < size; ++i)
      if (tested.squared[i] <= limit_[first + i])
        around += visit_discs(ray, groups_[first + i], whole_[first + i] == 0, visit);
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
      const std::uint32_t count = std::min<std::uint32_t>(size, group.size - first);
      const auto tested =
          centres_.test(ray, group.first + first, squared_around_, first_ones[count].data(), near_limits_.data());
      if (counts_each) around += tested.weight;
      if (tested.open == 0) continue;
      for (std::uint32_t i = 0; i < count; ++i)
        if (tested.squared[i] <= squared_near_) visit((group.first + first + i) * step_);
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
  PointBlocks::Distances near_limits_;
  PointBlocks centres_;  ///< of the discs
  std::vector<Group> groups_;
  PointBlocks group_middles_;
  std::vector<std::uint32_t> whole_;  ///< number of discs, if the group counts as a whole, else 0
  std::vector<float> limit_;          ///< of the squared distance of the middle, up to which discs are looked at
  PointBlocks block_middles_;
  std::vector<float> blocks_;  ///< limits of the blocks
};

}  // namespace detp::sim
