#pragma once

#include <vector>

#include "detp/sim/geometry/curve.hpp"
#include "detp/sim/open/uniform_discs.hpp"

/// Samples in the order of the Morton curve, and balls that move along these samples. Used by the parts of
/// rebuild_law_table.
namespace detp::tables {

using Points = std::vector<glm::dvec3>;

/// Side of the samples' cube. extent_of() is the volume (D = 3) or area (D = 2) that the samples fill.
inline constexpr double side = 2;
inline double extent_of(int dimension) { return dimension == 3 ? 8 : 24; }

/// Samples uniform in the cube [-1, 1]³ (dimension 3) or on its faces (2), in the curve's order.
inline Points sorted_samples(int dimension, std::size_t count, std::uint64_t seed) {
  Points points;
  points.reserve(count);
  for (const sim::Disc& disc :
       sim::uniform_discs(dimension == 3 ? sim::Body::cube : sim::Body::cube_faces, side, count, 1, seed))
    points.push_back(disc.centre);
  Points walk;
  walk.reserve(count);
  for (const std::uint32_t i : sim::lebesgue_order(points)) walk.push_back(points[i]);
  return walk;
}

/// `sets` such sets; each has a seed of its own, from `seed` on.
inline std::vector<Points> sets_of(int dimension, std::size_t count, std::size_t sets, std::uint64_t seed) {
  std::vector<Points> all;
  for (std::size_t set = 0; set < sets; ++set) all.push_back(sorted_samples(dimension, count, seed + set));
  return all;
}

/// Nested balls that follow the samples, the outermost first. A ball keeps its place while this ball and all balls
/// around it contain the next samples.
class NestedBalls {
 public:
  explicit NestedBalls(const std::vector<double>& radii) : centres_(radii.size()) {
    for (const double radius : radii) squares_.push_back(radius * radius);
  }

  /// Moves to this sample all balls that must move. Returns the index of the outermost of them, or the number of balls
  /// if none moves.
  std::size_t visit(const glm::dvec3& sample) {
    std::size_t i = 0;
    if (visited_)
      while (i < squares_.size() && holds(i, sample)) ++i;
    visited_ = true;
    for (std::size_t moved = i; moved < squares_.size(); ++moved) centres_[moved] = sample;
    return i;
  }

  [[nodiscard]] const glm::dvec3& centre(std::size_t i) const { return centres_[i]; }

 private:
  [[nodiscard]] bool holds(std::size_t i, const glm::dvec3& sample) const {
    const glm::dvec3 offset = sample - centres_[i];
    return glm::dot(offset, offset) <= squares_[i];
  }

  std::vector<double> squares_;
  Points centres_;
  bool visited_ = false;
};

/// Number of moves of each ball of a nest.
inline std::vector<double> moves(const Points& walk, const std::vector<double>& radii) {
  NestedBalls nest(radii);
  std::vector<double> first(radii.size() + 1);
  for (const glm::dvec3& sample : walk) ++first[nest.visit(sample)];
  for (std::size_t i = 1; i < radii.size(); ++i) first[i] += first[i - 1];
  first.pop_back();
  return first;
}

}  // namespace detp::tables
