#include "plate.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "detp/sim/geometry/dominant_axis.hpp"

namespace detp::sim {
namespace {

constexpr double most_sine = 1e-3;  // between planes that can be the same
constexpr double rounding = 1e-14;  // of the sine between two normals, and of distances

/// The plane of `other` cannot be within the slack of a part of `one` that is as wide as the smaller of them.
bool is_surely_apart(const Plate& one, const Plate& other, double slack) {
  constexpr double least_cosine = 1 - most_sine * most_sine;
  if (std::abs(glm::dot(one.normal, other.normal)) < least_cosine) return true;
  const double sine = glm::length(glm::cross(one.normal, other.normal));
  if (sine > std::min(most_sine, 4 * slack / std::min(one.height, other.height) + rounding)) return true;
  const double away = std::abs(glm::dot(one.normal, other.corners[0] - one.corners[0]));
  return away > 2 * slack + (sine + rounding) * other.longest;
}

}  // namespace

PlateView::PlateView(const Plate& plate)
    : origin_(plate.corners[0]), normal_(plate.normal), axis_(dominant_axis(plate.normal)) {
  u_ = normal_[axis_] > 0 ? (axis_ + 1) % 3 : (axis_ + 2) % 3;
  v_ = 3 - axis_ - u_;
  slope_ = -glm::dvec2{normal_[u_], normal_[v_]} / normal_[axis_];
}

FlatTriangle PlateView::flat(const Plate& other) const {
  FlatTriangle triangle{flat(other.corners[0]), flat(other.corners[1]), flat(other.corners[2])};
  if (glm::dot(normal_, other.normal) < 0) std::swap(triangle[1], triangle[2]);
  return triangle;
}

FlatPolygon PlateView::polygon(const Plate& plate) const {
  return {{flat(plate.corners[0]), 0}, {flat(plate.corners[1]), 1}, {flat(plate.corners[2]), 2}};
}

bool is_turned(const Plate& one, const Plate& other) { return glm::dot(one.normal, other.normal) < 0; }

bool coincide(const Plate& one, const Plate& other, double slack) {
  if (is_surely_apart(one, other, slack)) return false;
  const PlateView view(one);
  std::array<FlatCorner, 3> corners{};
  for (std::size_t i = 0; i < 3; ++i) corners[i].place = view.flat(one.corners[i]);
  const FlatTriangle triangle = view.flat(other);
  if (!may_overlap(corners, triangle, slack)) return false;
  const FlatCut both = cut({corners.begin(), corners.end()}, triangle, slack);
  const glm::dvec3 between = other.corners[0] - one.corners[0];
  const auto is_in_plane = [&](const FlatCorner& corner) {
    return std::abs(glm::dot(other.normal, view.offset(corner.place) - between)) <= slack;
  };
  return !both.inside.empty() && std::ranges::all_of(both.inside, is_in_plane);
}

}  // namespace detp::sim
