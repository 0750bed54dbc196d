#include <numbers>

#include "draw.hpp"
#include "families.hpp"

namespace detp::sim::families {
namespace {

/// A sphere without a cap at one end of its axis; looks inwards and outwards alike.
struct Shell {
  glm::dvec3 centre;
  double radius;
  glm::dvec3 axis;   ///< of unit length
  double open;       ///< half the angle of the hole
  double flattened;  ///< its height over its width
};

void add_shell(Mesh& mesh, const Shell& shell, double cell) {
  const glm::dvec3 aside = std::abs(shell.axis.y) < 0.9 ? glm::dvec3{0, 1, 0} : glm::dvec3{1, 0, 0};
  const glm::dvec3 first = glm::normalize(glm::cross(shell.axis, aside));
  const glm::dvec3 second = glm::cross(shell.axis, first);
  constexpr double pole = 0.05;  // so that no triangle is without area
  const int around = std::clamp(cells_along(2 * std::numbers::pi * shell.radius, cell), 6, 400);
  const int along = std::clamp(cells_along((std::numbers::pi - shell.open) * shell.radius, cell), 3, 200);
  add_patch(mesh, {around, along}, [&](double u, double v) {
    const double phi = 2 * std::numbers::pi * u;
    const double theta = shell.open + (std::numbers::pi - pole - shell.open) * v;
    return shell.centre + shell.radius * (shell.flattened * std::cos(theta) * shell.axis +
                                          std::sin(theta) * (std::cos(phi) * first + std::sin(phi) * second));
  });
}

}  // namespace

built_in::LitMesh shells(std::uint64_t seed) {
  Draw draw(seed, 5);
  LitMesh lit_mesh;
  Mesh& mesh = lit_mesh.mesh;
  add_materials(mesh, draw, 2);
  const int count = draw.whole(1, 6);
  const double outer = draw.log_between(0.5, 20);
  const double cell = draw.log_between(0.02, 0.08) * outer;
  double radius = outer;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 direction = draw.in({-1, -1, -1}, {1, 1, 1});
    add_shell(mesh,
              {.centre = 0.1 * radius * direction,
               .radius = radius,
               .axis = glm::normalize(direction + glm::dvec3{0, 0.01, 0}),
               .open = draw.between(0.1, 1.5),
               .flattened = draw.between(0.2, 1)},
              cell);
    paint(mesh, static_cast<std::uint16_t>(i % 2));
    radius *= draw.between(0.4, 0.9);
  }
  lit_mesh.lights.push_back({PointLight{0.1 * radius * draw.in({-1, -1, -1}, {1, 1, 1})}});
  if (draw.chance(0.4)) lit_mesh.lights.push_back({EnvironmentLight{}, draw.between(0.2, 2)});
  return lit_mesh;
}

}  // namespace detp::sim::families
