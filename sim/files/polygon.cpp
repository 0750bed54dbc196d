#include "polygon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace detp::sim {
namespace {

constexpr double least_area = 1e-13;  // twice an area, over the square of the extent: below it is rounding
constexpr double least_bend = 1e-3;   // distance from the mean plane, over the extent, that is no rounding of a file

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Of a triangle: its two shorter edges are not parallel.
bool has_area(std::span<const glm::dvec3> corners) {
  constexpr double surely = 1e-20;  // of most triangles, the square of a sine is larger
  constexpr double vanishing = 1e-250;
  const glm::dvec3 u = corners[1] - corners[0];
  const glm::dvec3 v = corners[2] - corners[0];
  const glm::dvec3 across = glm::cross(u, v);
  const double square = glm::dot(across, across);
  if (square > surely * glm::dot(u, u) * glm::dot(v, v) && square > vanishing && std::isfinite(square)) return true;
  constexpr double rounding = 1e-15;
  const std::array edges{corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]};
  std::array<double, 3> lengths{};
  for (std::size_t i = 0; i < 3; ++i) lengths[i] = std::hypot(edges[i].x, edges[i].y, edges[i].z);
  const auto longest = static_cast<std::size_t>(std::ranges::max_element(lengths) - lengths.begin());
  const std::size_t first = (longest + 1) % 3;
  const std::size_t second = (longest + 2) % 3;
  if (!(lengths[first] > 0 && lengths[second] > 0)) return false;
  return glm::length(glm::cross(edges[first] / lengths[first], edges[second] / lengths[second])) > rounding;
}

}  // namespace

/// Fills in flat_. False if the polygon has no area.
bool Triangulator::project(std::span<const glm::dvec3> corners) {
  double extent = 0;
  for (const glm::dvec3& corner : corners)
    for (int axis = 0; axis < 3; ++axis) extent = std::max(extent, std::abs(corner[axis] - corners[0][axis]));
  if (!(extent > 0) || std::isinf(extent)) return false;
  const auto at = [&](std::size_t i) { return (corners[i % corners.size()] - corners[0]) / extent; };
  glm::dvec3 normal{0.0};  // twice the area
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) normal += glm::cross(at(i), at(i + 1));
  const double length = glm::length(normal);
  if (!(length > least_area)) return false;
  const glm::dvec3 unit = normal / length;
  double low = 0;
  double high = 0;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    low = std::min(low, glm::dot(at(i), unit));
    high = std::max(high, glm::dot(at(i), unit));
  }
  if (high - low > least_bend) ++counts_.not_plane;
  int axis = 0;
  for (int other = 1; other < 3; ++other)
    if (std::abs(normal[other]) > std::abs(normal[axis])) axis = other;
  const int u = normal[axis] > 0 ? (axis + 1) % 3 : (axis + 2) % 3;
  const int v = 3 - axis - u;
  flat_.resize(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) flat_[i] = {at(i)[u], at(i)[v]};
  left_ = std::abs(normal[axis]);
  return true;
}

/// Twice the area of a triangle; below 0 if it is clockwise.
double Triangulator::turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  return cross(flat_[b] - flat_[a], flat_[c] - flat_[a]);
}

bool Triangulator::is_fan(std::uint32_t around) const {
  const auto n = static_cast<std::uint32_t>(flat_.size());
  for (std::uint32_t i = 1; i + 1 < n; ++i)
    if (!(turn(around, (around + i) % n, (around + i + 1) % n) > least_area)) return false;
  return true;
}

void Triangulator::divide(std::span<const glm::dvec3> corners, StopCheck& check,
                          std::vector<std::array<std::uint32_t, 3>>& to) {
  const auto n = static_cast<std::uint32_t>(corners.size());
  if (n == 3) {
    if (!has_area(corners)) ++counts_.degenerate;
    return to.push_back({0, 1, 2});
  }
  const auto add_fan = [&](std::uint32_t around) {
    for (std::uint32_t i = 1; i + 1 < n; ++i) to.push_back({around, (around + i) % n, (around + i + 1) % n});
  };
  if (!project(corners)) {
    ++counts_.degenerate;
    return add_fan(0);
  }
  for (std::uint32_t around = 0; around < n; ++around) {
    check.after(1);
    if (is_fan(around)) return add_fan(around);
  }
  ++counts_.split;
  cut_ears(check, to);
}

std::span<const std::array<std::uint32_t, 3>> Triangulator::triangles_of(std::span<const std::uint32_t> polygon,
                                                                         std::span<const glm::dvec3> positions,
                                                                         StopCheck& check) {
  corners_.clear();
  for (const std::uint32_t corner : polygon) corners_.push_back(positions[corner]);
  triangles_.clear();
  divide(corners_, check, triangles_);
  for (auto& triangle : triangles_)
    for (std::uint32_t& corner : triangle) corner = polygon[corner];
  return triangles_;
}

void Triangulator::cut_ears(StopCheck& check, std::vector<std::array<std::uint32_t, 3>>& to) {
  rest_ = static_cast<std::uint32_t>(flat_.size());
  before_.resize(rest_);
  after_.resize(rest_);
  for (std::uint32_t i = 0; i < rest_; ++i) {
    before_[i] = (i + rest_ - 1) % rest_;
    after_[i] = (i + 1) % rest_;
  }
  bool crossed = false;
  for (std::uint32_t corner = 0; rest_ > 2;) {
    Ears ears = Ears::clean;
    for (std::uint32_t seen = 0; !may_cut(corner, ears); corner = after_[corner]) {
      check.after(1 + rest_ / 8);
      if (++seen < rest_) continue;
      seen = 0;
      ears = static_cast<Ears>(static_cast<int>(ears) + 1);
    }
    const std::uint32_t a = before_[corner];
    const std::uint32_t c = after_[corner];
    crossed = crossed || ears == Ears::any;
    to.push_back({a, corner, c});
    left_ -= turn(a, corner, c);
    after_[a] = c;
    before_[c] = a;
    --rest_;
    corner = after_[c];  // not c: ears one after another would make a fan of slivers
  }
  if (crossed) ++counts_.degenerate;
}

bool Triangulator::may_cut(std::uint32_t corner, Ears ears) const {
  const std::array<std::uint32_t, 3> ear{before_[corner], corner, after_[corner]};
  const double area = turn(ear[0], ear[1], ear[2]);
  if (ears == Ears::any) return true;
  if (ears == Ears::spikes || ears == Ears::flat) {
    const bool turns_back = glm::dot(flat_[ear[0]] - flat_[corner], flat_[ear[2]] - flat_[corner]) > 0;
    return std::abs(area) <= least_area && (ears == Ears::flat || turns_back);
  }
  if (!(area > least_area)) return false;
  if (rest_ == 3) return true;
  if (ears == Ears::clean && !(area < left_ - least_area)) return false;  // the rest would have no area
  for (std::uint32_t other = after_[ear[2]]; other != ear[0]; other = after_[other])
    if (turn(before_[other], other, after_[other]) <= least_area && blocks(other, ear, ears == Ears::clean))
      return false;
  return true;
}

/// Whether the outline at the corner `other` runs inside the ear; with `on_cut`, also if the corner lies on the cut.
bool Triangulator::blocks(std::uint32_t other, const std::array<std::uint32_t, 3>& ear, bool on_cut) const {
  const auto& [a, b, c] = ear;
  for (std::size_t i = 0; i < 3; ++i)
    if (flat_[other] == flat_[ear[i]]) return enters(other, ear[i], ear[(i + 1) % 3], ear[(i + 2) % 3]);
  const std::array<double, 3> sides{turn(a, b, other), turn(b, c, other), turn(c, a, other)};
  if (std::ranges::any_of(sides, [](double side) { return side < -least_area; })) return false;
  if (sides[2] <= least_area) return on_cut;
  if (sides[0] > least_area && sides[1] > least_area) return true;
  // It touches an edge of the ear, from inside if the outline goes on there.
  const std::uint32_t from = sides[0] <= least_area ? a : b;
  const std::uint32_t to = sides[0] <= least_area ? b : c;
  return turn(from, to, before_[other]) > least_area || turn(from, to, after_[other]) > least_area;
}

/// Whether the outline at the corner `other`, which lies at the ear's corner `at`, runs between the ear's edges.
bool Triangulator::enters(std::uint32_t other, std::uint32_t at, std::uint32_t from, std::uint32_t to) const {
  return std::ranges::any_of(std::array{before_[other], after_[other]}, [&](std::uint32_t next) {
    return turn(at, from, next) > least_area && turn(at, next, to) > least_area;
  });
}

}  // namespace detp::sim
