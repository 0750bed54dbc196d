#include "seen_lights.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <numbers>

#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/photons/emitter.hpp"

namespace detp::sim {
namespace {

using std::numbers::pi;

double squared(double x) { return x * x; }

/// The share of light that is found with a density which also another search finds.
double share(double density, double of_other) { return density < unbounded ? density / (density + of_other) : 1; }

double radius_around(const Box& box) { return 0.5 * (1 + 1e-6) * glm::length(box.size()); }

/// Radiance, intensity, or irradiance of parallel light.
double strength_of(const Light& light, const Scene& scene) {
  if (const auto* spot = std::get_if<SpotLight>(&light.shape))
    return light.flux / (4 * pi * squared(std::sin(0.5 * spot->half_angle)));
  if (const auto* area = std::get_if<AreaLight>(&light.shape))
    return light.flux / (pi * glm::length(glm::cross(area->edge_u, area->edge_v)));
  switch (kind_of(light)) {
    case LightKind::point:
      return light.flux / (4 * pi);
    case LightKind::directional:
      return light.flux / (pi * squared(radius_around(scene.box)));
    case LightKind::environment:
      return light.flux / squared(2 * pi * radius_around(scene.box));
    default:
      return light.flux;
  }
}

/// Towards a point of a light, whose irradiance the caller sets.
SeenLight towards(const glm::dvec3& place, const glm::dvec3& point) {
  const glm::dvec3 way = place - point;
  const double distance = glm::length(way);
  return {.direction = distance > 0 ? way / distance : glm::dvec3{0.0}, .distance = distance};
}

}  // namespace

SeenLights::SeenLights(const Scene& scene) : scene_(scene) {
  double flux = 0;
  for (const Light& light : scene.lights)
    if (kind_of(light) != LightKind::environment) flux += light.flux;
  double sum = 0;
  for (const Light& light : scene.lights) {
    const double strength = strength_of(light, scene);
    if (kind_of(light) == LightKind::environment) {
      environment_ += strength;
      continue;
    }
    if (kind_of(light) == LightKind::surface) surface_scale_ += light.flux / emitted_flux(scene.mesh);
    if (light.flux > 0) sources_.push_back({&light, sum += light.flux / flux, light.flux / flux, strength});
  }
  if (surface_scale_ == 0) return;
  double fluxes = 0;
  for (std::uint32_t i = 0; i < scene.mesh.triangles.size(); ++i) {
    for (const bool front : {true, false}) {
      const double radiance = scene.mesh.materials.emitted(i, front);
      if (!(radiance > 0)) continue;
      const auto& [a, b, c] = scene.mesh.triangles[i];
      const auto& places = scene.mesh.positions;
      const glm::dvec3 across = glm::cross(places[b] - places[a], places[c] - places[a]);
      const double area = 0.5 * glm::length(across);
      const glm::dvec3 normal = unit_or_zero(across);
      if (area > 0) emitting_.push_back({i, fluxes += pi * radiance * area, area, front ? normal : -normal, radiance});
    }
  }
  for (const Source& source : sources_)
    if (kind_of(*source.light) == LightKind::surface) surface_density_ += source.probability / fluxes;
}

SeenLight SeenLights::sample(const glm::dvec3& point, const std::array<double, 4>& random) const {
  if (sources_.empty()) return {};
  const auto source = std::upper_bound(sources_.begin(), sources_.end() - 1, random[0],
                                       [](double number, const Source& one) { return number < one.up_to; });
  const double before = source->up_to - source->probability;
  const double rest = std::clamp((random[0] - before) / source->probability, 0.0, 1.0);
  SeenLight found = std::visit(
      [&](const auto& shape) {
        if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, SurfaceLight>)
          return seen(shape, rest, point, random[1], random[2]);
        else
          return seen(shape, source->strength, point, random[1], random[2]);
      },
      source->light->shape);
  found.irradiance /= source->probability;
  if (!found.triangle) found.density *= source->probability;
  return found;
}

SeenLight SeenLights::seen(const PointLight& light, double strength, const glm::dvec3& point, double, double) const {
  SeenLight found = towards(light.position, point);
  if (found.distance > 0) found.irradiance = strength / squared(found.distance);
  return found;
}

SeenLight SeenLights::seen(const SpotLight& light, double strength, const glm::dvec3& point, double, double) const {
  SeenLight found = towards(light.position, point);
  const bool inside = -glm::dot(found.direction, unit_or_zero(light.direction)) >= std::cos(light.half_angle);
  if (found.distance > 0 && inside) found.irradiance = strength / squared(found.distance);
  return found;
}

SeenLight SeenLights::seen(const AreaLight& light, double strength, const glm::dvec3& point, double u, double v) const {
  const glm::dvec3 across = glm::cross(light.edge_u, light.edge_v);
  SeenLight found = towards(light.corner + u * light.edge_u + v * light.edge_v, point);
  const double cosine_area = -glm::dot(found.direction, across);
  if (!(found.distance > 0 && cosine_area > 0)) return found;
  found.irradiance = strength * cosine_area / squared(found.distance);
  found.density = squared(found.distance) / cosine_area;
  return found;
}

SeenLight SeenLights::seen(const DirectionalLight& light, double strength, const glm::dvec3&, double, double) const {
  return {.direction = -unit_or_zero(light.direction), .distance = unbounded, .irradiance = strength};
}

/// `number`: a uniform number, by which the triangle is chosen.
SeenLight SeenLights::seen(const SurfaceLight&, double number, const glm::dvec3& point, double u, double v) const {
  const double flux = number * emitting_.back().up_to;
  const auto one = std::upper_bound(emitting_.begin(), emitting_.end() - 1, flux,
                                    [](double sum, const Emitting& other) { return sum < other.up_to; });
  const auto& [a, b, c] = scene_.mesh.triangles[one->triangle];
  const auto& places = scene_.mesh.positions;
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  SeenLight found = towards(places[a] + u * (places[b] - places[a]) + v * (places[c] - places[a]), point);
  found.triangle = one->triangle;
  const double cosine = -glm::dot(found.direction, one->normal);
  if (!(found.distance > 0 && cosine > least_cosine)) return found;
  const double probability =
      (one->up_to - (one == emitting_.begin() ? 0 : std::prev(one)->up_to)) / emitting_.back().up_to;
  const double radiance = surface_scale_ * one->radiance;
  found.irradiance = radiance * one->area * cosine / (squared(found.distance) * probability);
  found.density = surface_density(one->radiance, found.distance, cosine);
  return found;
}

/// Probability per solid angle that `sample` chooses a direction to a triangle with this radiance: it chooses points by
/// their flux.
double SeenLights::surface_density(double radiance, double distance, double cosine) const {
  return surface_density_ * pi * radiance * squared(distance) / cosine;
}

double SeenLights::radiance_on_the_way(const Look& look, double distance) const {
  double radiance = 0;
  for (const Source& source : sources_) {
    const auto* area = std::get_if<AreaLight>(&source.light->shape);
    if (area == nullptr) continue;
    const glm::dvec3 across = glm::cross(area->edge_u, area->edge_v);
    const double facing = glm::dot(look.direction, across);
    if (!(facing < 0)) continue;
    const double way = glm::dot(area->corner - look.origin, across) / facing;
    if (!(way > 0 && way < distance)) continue;
    const glm::dvec3 place = look.origin + way * look.direction - area->corner;
    const double square = glm::dot(across, across);
    const double u = glm::dot(glm::cross(place, area->edge_v), across) / square;
    const double v = glm::dot(glm::cross(area->edge_u, place), across) / square;
    if (u >= 0 && u <= 1 && v >= 0 && v <= 1)
      radiance += source.strength * share(look.density, source.probability * squared(way) / -facing);
  }
  return radiance;
}

double SeenLights::radiance_of(std::uint32_t triangle, const Look& look, double distance) const {
  const Materials& materials = scene_.mesh.materials;
  if (!(surface_scale_ > 0 && (materials.of(triangle).emitted > 0 || materials.has_back(triangle)))) return 0;
  const auto& [a, b, c] = scene_.mesh.triangles[triangle];
  const auto& places = scene_.mesh.positions;
  const double cosine =
      -glm::dot(unit_or_zero(glm::cross(places[b] - places[a], places[c] - places[a])), look.direction);
  const double emitted = materials.emitted(triangle, cosine > 0);
  if (!(emitted > 0) || cosine == 0) return 0;
  return surface_scale_ * emitted * share(look.density, surface_density(emitted, distance, std::abs(cosine)));
}

}  // namespace detp::sim
