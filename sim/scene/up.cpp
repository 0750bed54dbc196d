#include "up.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>

#include "detp/sim/base/stop_check.hpp"

namespace detp::sim {
namespace {

constexpr int columns = 32;         // along each side of the box
constexpr double margin = 0.15;     // of the box, in which floors and ceilings lie
constexpr double horizontal = 0.8;  // least |cos| between a horizontal surface's normal and the vertical
constexpr double lead_of_y = 0.15;  // in coverage, over the other axes
constexpr double lead_of_z = 0.05;  // over X
constexpr double least_downwards = 0.2;
constexpr double ground = 0.75;  // least coverage of a scene that has ground or a floor
constexpr int most_pieces = 64;  // along an edge of a triangle

using Grid = std::bitset<columns * columns>;

/// The horizontal surfaces as seen along one axis.
struct View {
  Grid any, low, high;
  double up = 0, down = 0;  ///< area that faces along the axis, and against it

  [[nodiscard]] double coverage() const { return share(any); }
  /// Positive if the surfaces say that the axis points up, negative if it points down.
  [[nodiscard]] double upwards() const {
    return share(low) - share(high) + (up + down > 0 ? (up - down) / (up + down) : 0);
  }

 private:
  static double share(const Grid& grid) { return static_cast<double>(grid.count()) / (columns * columns); }
};

/// Marks a point, in [0, 1]³ of the box.
void mark(View& view, int axis, const glm::dvec3& point) {
  const auto cell = [](double share) { return std::clamp(static_cast<int>(columns * share), 0, columns - 1); };
  const auto column = static_cast<std::size_t>(columns * cell(point[(axis + 1) % 3]) + cell(point[(axis + 2) % 3]));
  view.any.set(column);
  if (point[axis] < margin) view.low.set(column);
  if (point[axis] > 1 - margin) view.high.set(column);
}

/// A triangle whose corners are relative to the box, in units of its longest side.
struct Triangle {
  glm::dvec3 corner, first, second;
};

void add(std::array<View, 3>& views, const Triangle& triangle, const glm::dvec3& size) {
  const glm::dvec3 across = glm::cross(triangle.first, triangle.second);
  const double area = glm::length(across);
  if (!(area > 0)) return;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(across[axis]) < horizontal * area) continue;
    View& view = views[static_cast<std::size_t>(axis)];
    (across[axis] > 0 ? view.up : view.down) += std::abs(across[axis]);
    const double longest = std::max(glm::length(triangle.first), glm::length(triangle.second));
    const int pieces = std::clamp(static_cast<int>(2 * columns * longest), 1, most_pieces);
    for (int i = 0; i < pieces; ++i)
      for (int j = 0; i + j < pieces; ++j)
        mark(view, axis,
             (triangle.corner + (i + 1.0 / 3) / pieces * triangle.first + (j + 1.0 / 3) / pieces * triangle.second) /
                 size);
  }
}

}  // namespace

glm::dvec3 Up::to_y(const glm::dvec3& vector) const {
  glm::dvec3 turned;
  for (int i = 0; i < 3; ++i) turned[(i + 1) % 3] = vector[(axis + i) % 3];
  return sign > 0 ? turned : glm::dvec3{-turned.x, -turned.y, turned.z};
}

glm::dvec3 Up::from_y(const glm::dvec3& vector) const {
  const glm::dvec3 upright = sign > 0 ? vector : glm::dvec3{-vector.x, -vector.y, vector.z};
  glm::dvec3 turned;
  for (int i = 0; i < 3; ++i) turned[(axis + i) % 3] = upright[(i + 1) % 3];
  return turned;
}

std::string_view name(const Up& up) {
  return std::find_if(named_ups.begin(), named_ups.end(), [&](const auto& named) { return named.second == up; })->first;
}

Up up_of(const Mesh& mesh, const Box& box, const std::stop_token& stop) {
  const double unit = box.longest_side();
  if (!(unit > 0)) return {};
  const glm::dvec3 size = glm::max(box.size() / unit, 1e-6);
  std::array<View, 3> views;
  StopCheck check(stop, "finding up");
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec3 corner = (mesh.positions[a] - box.low) / unit;
    add(views, {corner, (mesh.positions[b] - mesh.positions[a]) / unit, (mesh.positions[c] - mesh.positions[a]) / unit},
        size);
    check.after(1);
  }
  const std::array<double, 3> score{views[0].coverage(), views[1].coverage() + lead_of_y,
                                    views[2].coverage() + lead_of_z};
  const auto best = static_cast<std::size_t>(std::max_element(score.begin(), score.end()) - score.begin());
  if (views[best].coverage() < ground) return {};
  return {static_cast<int>(best), views[best].upwards() < -least_downwards ? -1 : 1};
}

}  // namespace detp::sim
