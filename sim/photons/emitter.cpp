#include "emitter.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/turn.hpp"

namespace detp::sim {
namespace {

void require_finite_vector(const char* what, const glm::dvec3& vector) {
  for (int axis = 0; axis < 3; ++axis) require_finite(what, vector[axis]);
}

glm::dvec3 unit_direction(const char* what, const glm::dvec3& direction) {
  require_finite_vector(what, direction);
  const glm::dvec3 unit = unit_or_zero(direction);
  if (unit == glm::dvec3{0.0}) throw std::invalid_argument(std::string(what) + " must not be zero");
  return unit;
}

/// A sphere around the scene's box, a little larger, so that photons start outside of all surfaces.
Sphere around(const Box& box) {
  const glm::dvec3 half = 0.5 * box.size();
  return {box.centre(), (1 + 1e-6) * std::hypot(half.x, half.y, half.z)};
}

Emitter emitter(const PointLight& light, const Scene&) {
  require_finite_vector("position of the point light", light.position);
  return [light](const std::array<double, 4>& random) {
    return PhotonStart{light.position, uniform_direction(random[2], random[3])};
  };
}

Emitter emitter(const AreaLight& light, const Scene&) {
  require_finite_vector("corner of the area light", light.corner);
  require_finite_vector("first edge of the area light", light.edge_u);
  require_finite_vector("second edge of the area light", light.edge_v);
  const glm::dvec3 normal = unit_or_zero(glm::cross(unit_or_zero(light.edge_u), unit_or_zero(light.edge_v)));
  if (normal == glm::dvec3{0.0}) throw std::invalid_argument("area light has no area; its edges must not be parallel");
  return [light, normal](const std::array<double, 4>& random) {
    return PhotonStart{light.corner + random[0] * light.edge_u + random[1] * light.edge_v,
                       cosine_direction(normal, random[2], random[3])};
  };
}

Emitter emitter(const SpotLight& light, const Scene&) {
  require_finite_vector("position of the spot light", light.position);
  const glm::dvec3 axis = unit_direction("direction of the spot light", light.direction);
  require_positive("half angle of the spot light", light.half_angle);
  if (light.half_angle > std::numbers::pi)
    throw std::invalid_argument("half angle of the spot light must be at most pi (got " +
                                std::to_string(light.half_angle) + ")");
  // 1 - cos of the half angle, without cancellation
  const double cap = 2 * std::pow(std::sin(0.5 * light.half_angle), 2);
  return [position = light.position, axis, cap](const std::array<double, 4>& random) {
    const double below = cap * random[2];
    const double across = std::sqrt(below * (2 - below));
    const Turn around_axis = turn(random[3]);
    const auto [first, second] = basis_around(axis);
    return PhotonStart{position, glm::normalize((1 - below) * axis + across * around_axis.cos * first +
                                                across * around_axis.sin * second)};
  };
}

Emitter emitter(const DirectionalLight& light, const Scene& scene) {
  const glm::dvec3 direction = unit_direction("direction of the directional light", light.direction);
  return [direction, sphere = around(scene.box)](const std::array<double, 4>& random) {
    const double radius = sphere.radius * std::sqrt(random[0]);
    const Turn place = turn(random[1]);
    const auto [first, second] = basis_around(direction);
    return PhotonStart{
        sphere.centre - sphere.radius * direction + radius * place.cos * first + radius * place.sin * second,
        direction};
  };
}

/// Uniform on the sphere, inwards by the cosine law: lines of the measure μ_ℓ.
Emitter emitter(const EnvironmentLight&, const Scene& scene) {
  return [sphere = around(scene.box)](const std::array<double, 4>& random) {
    const glm::dvec3 outwards = uniform_direction(random[0], random[1]);
    return PhotonStart{sphere.centre + sphere.radius * outwards, cosine_direction(-outwards, random[2], random[3])};
  };
}

Box starts(const PointLight& light, const Scene&) { return {light.position, light.position}; }
Box starts(const SpotLight& light, const Scene&) { return {light.position, light.position}; }
Box starts(const AreaLight& light, const Scene&) {
  Box box{light.corner, light.corner};
  for (const glm::dvec3& edge : {light.edge_u, light.edge_v, light.edge_u + light.edge_v})
    box.include(light.corner + edge);
  return box;
}
Box starts(const SurfaceLight&, const Scene& scene) { return scene.box; }
Box starts(const EnvironmentLight&, const Scene& scene) {
  const Sphere sphere = around(scene.box);
  return {sphere.centre - sphere.radius, sphere.centre + sphere.radius};
}
/// A disc that touches the sphere around the scene.
Box starts(const DirectionalLight&, const Scene& scene) {
  const Sphere sphere = around(scene.box);
  const double reach = std::numbers::sqrt2 * sphere.radius;
  return {sphere.centre - reach, sphere.centre + reach};
}

/// A side of a triangle that emits: the cross product of the edges points away from it.
struct EmittingTriangle {
  std::uint32_t number;
  glm::dvec3 corner, first, second;  ///< a corner, and the edges from it
  bool back;
  double up_to;  ///< sum of the fluxes of all emitting sides up to and including this one
};

std::vector<EmittingTriangle> emitting_triangles(const Mesh& mesh) {
  std::vector<EmittingTriangle> all;
  double sum = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const bool front : {true, false}) {
      const double emitted = mesh.materials.emitted(i, front);
      if (!(emitted > 0)) continue;
      auto [a, b, c] = mesh.triangles[i];
      if (!front) std::swap(b, c);
      const glm::dvec3 first = mesh.positions[b] - mesh.positions[a];
      const glm::dvec3 second = mesh.positions[c] - mesh.positions[a];
      const double flux = 0.5 * std::numbers::pi * emitted * glm::length(glm::cross(first, second));
      if (flux > 0)
        all.push_back({static_cast<std::uint32_t>(i), mesh.positions[a], first, second, !front, sum += flux});
    }
  }
  return all;
}

Emitter emitter(const SurfaceLight&, const Scene& scene) {
  std::vector<EmittingTriangle> all = emitting_triangles(scene.mesh);
  if (all.empty())
    throw std::invalid_argument("no triangle of " + scene.name + " emits light; give a material that emits");
  return [all = std::move(all)](const std::array<double, 4>& random) {
    const double flux = random[0] * all.back().up_to;
    const auto found = std::upper_bound(all.begin(), all.end() - 1, flux,
                                        [](double sum, const EmittingTriangle& one) { return sum < one.up_to; });
    const double before = found == all.begin() ? 0 : std::prev(found)->up_to;
    // what is left of the first number is uniform again
    double u = std::clamp((flux - before) / (found->up_to - before), 0.0, 1.0);
    double v = random[1];
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    return PhotonStart{found->corner + u * found->first + v * found->second,
                       cosine_direction(unit_or_zero(glm::cross(found->first, found->second)), random[2], random[3]),
                       found->number, found->back};
  };
}

}  // namespace

Emitter emitter_of(const Light& light, const Scene& scene) {
  return std::visit([&](const auto& shape) { return emitter(shape, scene); }, light.shape);
}

Box starts_of(const Light& light, const Scene& scene) {
  return std::visit([&](const auto& shape) { return starts(shape, scene); }, light.shape);
}

double emitted_flux(const Mesh& mesh) {
  const std::vector<EmittingTriangle> all = emitting_triangles(mesh);
  return all.empty() ? 0 : all.back().up_to;
}

}  // namespace detp::sim
