#include "placed_lights.hpp"

#include <algorithm>
#include <numbers>

#include "detp/sim/base/stop_check.hpp"
#include "emitter.hpp"

namespace detp::sim {
namespace {

constexpr int lines_along_edge = 5;
constexpr double step = 0.01;   // distance between the heights tried, as a share of the box's height
constexpr int most_steps = 20;  // of `step`, below the top

/// The light at its place along X and Z, at the height of the box's top.
AreaLight level_light(const Box& box) {
  const glm::dvec3 size = box.size();
  const double least = 0.05 * box.longest_side();
  const double along_x = std::max(0.5 * size.x, least);
  const double along_z = std::max(0.5 * size.z, least);
  const glm::dvec3 middle = box.centre();
  return {.corner = {middle.x - 0.5 * along_x, box.high.y, middle.z - 0.5 * along_z},
          .edge_u = {along_x, 0, 0},
          .edge_v = {0, 0, along_z}};
}

/// A vertical line below the light, and the depths below the box's top at which it meets the mesh.
struct VerticalLine {
  double x, z;
  std::vector<double> depths;

  /// Distance from a depth down to the next surface; 0 if there is none.
  [[nodiscard]] double distance_down(double depth) const {
    const auto floor = std::upper_bound(depths.begin(), depths.end(), depth);
    return floor == depths.end() ? 0 : *floor - depth;
  }
};

/// Adds the depth at which the line meets the triangle, if any. Corners are relative to the centre of the box's top.
/// Vertical triangles are ignored.
void add_intersection(VerticalLine& line, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  if (line.x < std::min({a.x, b.x, c.x}) || line.x > std::max({a.x, b.x, c.x})) return;
  if (line.z < std::min({a.z, b.z, c.z}) || line.z > std::max({a.z, b.z, c.z})) return;
  const auto cross = [](const glm::dvec3& first, const glm::dvec3& second) {
    return first.x * second.z - first.z * second.x;
  };
  const glm::dvec3 to{line.x - a.x, 0, line.z - a.z};
  const double area = cross(b - a, c - a);
  const double u = cross(to, c - a) / area;
  const double v = cross(b - a, to) / area;
  if (u >= 0 && v >= 0 && u + v <= 1) line.depths.push_back(-(a.y + u * (b.y - a.y) + v * (c.y - a.y)));
}

/// The numbers of the first and the last line that may be between two coordinates, along an edge of the light.
std::pair<int, int> lines_between(const std::pair<double, double>& ends, double edge) {
  const auto line_at = [&](double at) {
    return std::clamp((at / edge + 0.5) * lines_along_edge - 0.5, -1.0, lines_along_edge + 1.0);
  };
  return {std::max(0, static_cast<int>(std::floor(line_at(ends.first))) - 1),
          std::min(lines_along_edge - 1, static_cast<int>(std::ceil(line_at(ends.second))) + 1)};
}

/// All coordinates are in units of the box's longest side. Box and light are turned so that Y is up; the mesh is not.
std::vector<VerticalLine> vertical_lines(const Mesh& mesh, const Up& up, const Box& box, const AreaLight& light,
                                         const std::stop_token& stop) {
  const double unit = box.longest_side();
  const glm::dvec3 top{box.centre().x, box.high.y, box.centre().z};
  std::vector<VerticalLine> all;
  for (int i = 0; i < lines_along_edge; ++i)
    for (int j = 0; j < lines_along_edge; ++j)
      all.push_back({.x = ((i + 0.5) / lines_along_edge - 0.5) * light.edge_u.x / unit,
                     .z = ((j + 0.5) / lines_along_edge - 0.5) * light.edge_v.z / unit,
                     .depths = {}});
  StopCheck check(stop, "placing the light");
  for (const auto& corners : mesh.triangles) {
    const auto placed = [&](int i) { return (up.to_y(mesh.positions[corners[i]]) - top) / unit; };
    const glm::dvec3 a = placed(0);
    const glm::dvec3 b = placed(1);
    const glm::dvec3 c = placed(2);
    const auto [first_x, last_x] = lines_between(std::minmax({a.x, b.x, c.x}), light.edge_u.x / unit);
    const auto [first_z, last_z] = lines_between(std::minmax({a.z, b.z, c.z}), light.edge_v.z / unit);
    for (int i = first_x; i <= last_x; ++i)
      for (int j = first_z; j <= last_z; ++j)
        add_intersection(all[static_cast<std::size_t>(i * lines_along_edge + j)], a, b, c);
    check.after(1);
  }
  for (VerticalLine& line : all) std::sort(line.depths.begin(), line.depths.end());
  return all;
}

/// Depth of the light below the box's top, as a share of the box's height.
double depth_of_light(const Mesh& mesh, const Up& up, const Box& box, const AreaLight& light,
                      const std::stop_token& stop) {
  const double height = box.size().y / box.longest_side();
  const std::vector<VerticalLine> all = vertical_lines(mesh, up, box, light, stop);
  for (int i = 1; i <= most_steps; ++i) {
    // The distance starts half a step higher, so that the light cannot lie in the ceiling.
    const auto is_far_above = [&](const VerticalLine& line) {
      return line.distance_down((i - 0.5) * step * height) >= 0.5 * height;
    };
    if (2 * std::count_if(all.begin(), all.end(), is_far_above) > std::ssize(all)) return i * step;
  }
  return step;
}

AreaLight area_light(const Mesh& mesh, const Box& box, const Up& up, const std::stop_token& stop) {
  Box upright;
  upright.include(up.to_y(box.low));
  upright.include(up.to_y(box.high));
  AreaLight light = level_light(upright);
  const double height = upright.size().y;
  const bool flat = height < 0.05 * upright.longest_side();
  light.corner.y += flat ? 0.5 * upright.longest_side() : -depth_of_light(mesh, up, upright, light, stop) * height;
  return {up.from_y(light.corner), up.from_y(light.edge_u), up.from_y(light.edge_v)};
}

glm::dvec3 middle(const AreaLight& light) { return light.corner + 0.5 * (light.edge_u + light.edge_v); }

}  // namespace

std::vector<Light> placed_lights(std::span<const LightKind> kinds, const Mesh& mesh, const Box& box, const Up& up,
                                 const std::stop_token& stop) {
  constexpr glm::dvec3 sunbeam{0.48, -0.8, 0.36};
  const auto placed = static_cast<double>(std::ranges::count_if(kinds, [](auto k) { return k != LightKind::surface; }));
  const auto light_of = [&](LightKind kind) -> Light {
    switch (kind) {
      case LightKind::area:
        return {area_light(mesh, box, up, stop), 1 / placed};
      case LightKind::point:
        return {PointLight{middle(area_light(mesh, box, up, stop))}, 1 / placed};
      case LightKind::spot:
        return {SpotLight{middle(area_light(mesh, box, up, stop)), up.from_y({0, -1, 0}), std::numbers::pi / 6},
                1 / placed};
      case LightKind::directional:
        return {DirectionalLight{up.from_y(sunbeam)}, 1 / placed};
      case LightKind::environment:
        return {EnvironmentLight{}, 1 / placed};
      case LightKind::surface:
        break;
    }
    return {SurfaceLight{}, emitted_flux(mesh)};
  };
  std::vector<Light> lights;
  for (const LightKind kind : kinds) lights.push_back(light_of(kind));
  return lights;
}

}  // namespace detp::sim
