#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string_view>
#include <vector>

#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/geometry.hpp"
#include "detp/sim/geometry/random.hpp"

/// Scenes of hard rays and discs, for all techniques.
namespace detp::support {

// Rays that just hit or just miss a disc or a sphere.

/// A sequence of random numbers for one case.
class RandomSequence {
 public:
  RandomSequence(std::uint64_t family, std::uint64_t index) : family_(family), index_(index) {}
  double uniform() {
    if (used_ % 4 == 0) four_ = sim::uniform4(900 + family_, sim::Stream::tests, index_, used_ / 4);
    return four_[used_++ % 4];
  }
  double between(double low, double high) { return low + (high - low) * uniform(); }
  double sign() { return uniform() < 0.5 ? -1 : 1; }
  /// Log-uniform.
  double magnitude(double low, double high) { return std::pow(10.0, between(low, high)); }
  bool one_in(double n) { return uniform() * n < 1; }
  /// 0, or log-uniform from 1e-17 to 1e-12 with either sign: offsets about as small as rounding errors.
  double rounding_offset() {
    const double side = one_in(4) ? 0 : sign();
    return side * magnitude(-17, -12);
  }
  glm::dvec3 direction() {
    const double u = uniform();
    return sim::uniform_direction(u, uniform());
  }
  /// An axis, a direction within 1e-8 of one, or any direction.
  glm::dvec3 normal() {
    const double kind = uniform();
    if (kind > 0.4) return glm::normalize(direction());
    glm::dvec3 axis{0.0};
    axis[static_cast<int>(3 * uniform())] = sign();
    const double tilt = kind < 0.2 ? 0 : magnitude(-17, -8);
    return glm::normalize(axis + tilt * direction());
  }

 private:
  std::uint64_t family_;
  std::uint64_t index_;
  std::uint64_t used_ = 0;
  std::array<double, 4> four_{};
};

/// The distribution of a family's cases. low and high are exponents of 10; `from` and `length` are in disc radii.
struct Family {
  std::string_view name;
  double cosine_low = -1, cosine_high = 0;  ///< |n·D|
  double from_low = -1, from_high = 2;      ///< from the ray's origin to where it crosses the plane
  double radius_low = -3, radius_high = 0;  ///< of the disc, relative to the scene's size
  double scale = 1;                         ///< size of the scene
  double offset = 0;  ///< distance of the scene from the coordinates' origin, in sizes of the scene
  double length_low = -1, length_high = 3;  ///< length of segments
  double unit = 0;                          ///< largest difference of a direction's length from 1
};

inline const std::array families{
    Family{.name = "tangent"},
    Family{.name = "grazing", .cosine_low = -12},
    Family{.name = "edge-on", .cosine_low = -18, .cosine_high = -12},
    Family{.name = "far away", .cosine_low = -6, .offset = 1e6},
    Family{.name = "from afar", .cosine_low = -4, .from_low = 2, .from_high = 9, .length_low = 1, .length_high = 10},
    Family{.name = "tiny", .cosine_low = -12, .scale = 1e-9},
    Family{.name = "huge", .cosine_low = -12, .scale = 1e9},
    Family{.name = "from inside", .cosine_low = -6, .from_low = -17, .from_high = 0},
    Family{
        .name = "very short", .cosine_low = -6, .from_low = -17, .from_high = -2, .length_low = -60, .length_high = -8},
    Family{.name = "not unit", .cosine_low = -12, .from_low = -1, .from_high = 9, .unit = 0.99e-12},
};

/// A direction D with |normal·D| = cosine. For a cosine below 1e-17, D is parallel to the plane within rounding.
inline glm::dvec3 slanting(RandomSequence& random, const glm::dvec3& normal, double cosine) {
  const auto [u, v] = sim::basis_around(normal);
  const double angle = random.between(0, 2 * std::numbers::pi);
  const glm::dvec3 along = std::cos(angle) * u + std::sin(angle) * v;
  return glm::normalize(std::sqrt(1 - cosine * cosine) * along + random.sign() * cosine * normal);
}

struct DiscCase {
  sim::Ray ray;
  sim::Disc disc;
};

/// A ray towards the rim of the disc, or, in one of four cases, towards any point of the disc. If it is a segment, it
/// ends near the disc's plane, near the disc, or far from it.
inline sim::Ray hard_ray(const Family& family, RandomSequence& random, const sim::Disc& disc) {
  const double cosine = std::min(1.0, random.magnitude(family.cosine_low, family.cosine_high));
  const glm::dvec3 direction = slanting(random, disc.normal, cosine);
  // The crossing is mostly near the rim, and often where the rim is parallel to the ray's projection on the plane.
  const glm::dvec3 sideways = glm::normalize(glm::cross(disc.normal, direction));
  const glm::dvec3 forwards = glm::cross(sideways, disc.normal);
  const double angle = random.one_in(2) ? random.rounding_offset() * 1e7 : random.between(0, 2 * std::numbers::pi);
  const double place = random.one_in(4) ? random.uniform() : 1 + random.rounding_offset();
  const glm::dvec3 crossing =
      disc.centre + place * disc.radius * (random.sign() * std::cos(angle) * sideways + std::sin(angle) * forwards);
  const double from = disc.radius * random.magnitude(family.from_low, family.from_high);
  sim::Ray ray{.origin = crossing - from * direction,
               .direction = direction * (1 + family.unit * random.between(-1, 1))};
  const double kind = random.uniform();
  if (kind < 0.15) ray.length = disc.radius * random.magnitude(family.length_low, family.length_high);
  if (kind >= 0.15 && kind < 0.3) ray.length = from * (1 + random.rounding_offset());
  if (kind >= 0.3 && kind < 0.4) ray.length = from + random.between(-1.5, 1.5) * disc.radius;
  if (kind >= 0.4 && kind < 0.5) ray.origin = crossing + random.rounding_offset() * direction, ray.length = from;
  if (!(ray.length > 0)) ray.length = std::numeric_limits<double>::min();
  return ray;
}

inline DiscCase hard_disc(const Family& family, std::uint64_t number, std::uint64_t index) {
  RandomSequence random(number, index);
  sim::Disc disc;
  disc.radius = family.scale * random.magnitude(family.radius_low, family.radius_high);
  const glm::dvec3 offset{family.offset, -0.3 * family.offset, 0.7 * family.offset};
  disc.centre = family.scale * (offset + glm::dvec3{random.uniform(), random.uniform(), random.uniform()});
  disc.normal = random.normal();
  if (random.one_in(8)) {  // numbers with few bits, so that exact ties occur
    disc.centre = family.scale * glm::floor(8.0 * disc.centre / family.scale) / 8.0;
    disc.radius = family.scale / 4;
  }
  sim::Ray ray = hard_ray(family, random, disc);
  if (!ray.is_line() && random.one_in(20)) ray.length = 0;
  // Far from the coordinates' origin, rounding moves the ray. So the rim is often moved to where the ray now crosses.
  const glm::dvec3 moment = glm::cross(ray.origin - disc.centre, ray.direction);
  const double crossed = glm::length(glm::cross(disc.normal, moment)) / std::abs(glm::dot(disc.normal, ray.direction));
  if (random.one_in(2) && std::abs(crossed - disc.radius) < 0.1 * disc.radius)
    disc.radius = crossed * (1 + random.rounding_offset());
  return {ray, disc};
}

struct SphereCase {
  sim::Ray ray;
  sim::Sphere sphere;
};

/// A sphere, and a ray through a point at about one radius from the centre; some rays end near this point. In every
/// second case the radius is then set to about the centre's distance from the ray.
inline SphereCase hard_sphere(const Family& family, std::uint64_t number, std::uint64_t index) {
  RandomSequence random(100 + number, index);
  const sim::Disc disc = hard_disc(family, number, index).disc;
  sim::Sphere sphere{disc.centre, disc.radius};
  const glm::dvec3 outwards = random.normal();
  const glm::dvec3 direction = random.one_in(3) ? -outwards : slanting(random, outwards, random.magnitude(-18, -1));
  const glm::dvec3 touch = sphere.centre + (1 + random.rounding_offset()) * sphere.radius * outwards;
  const double from = sphere.radius * random.magnitude(family.from_low, family.from_high);
  sim::Ray ray{.origin = touch - from * direction, .direction = direction * (1 + family.unit * random.between(-1, 1))};
  const double kind = random.uniform();
  if (kind < 0.2) ray.length = sphere.radius * random.magnitude(family.length_low, family.length_high);
  if (kind >= 0.2 && kind < 0.4) ray.length = from * (1 + random.rounding_offset());
  if (kind >= 0.4 && kind < 0.5) ray.origin = touch, ray.length = random.one_in(5) ? 0 : from;
  if (random.one_in(2)) {
    const glm::dvec3 f = sphere.centre - ray.origin;
    const double along = ray.is_line() ? glm::dot(f, direction) : std::clamp(glm::dot(f, direction), 0.0, ray.length);
    sphere.radius = glm::length(f - along * direction) * (1 + random.rounding_offset());
  }
  return {ray, sphere};
}

/// Discs that just touch the planes between cells, and rays that just hit or miss these discs.
struct HardScene {
  std::vector<sim::Disc> discs;
  std::vector<sim::Ray> rays;
};

/// A random disc for hard_scene. Its centre, or one point of its rim, lies on up to three planes between cells, with
/// errors of at most about 1e-10 (times `scale`). The planes follow from repeated halving of the scene's box.
/// hard_scene fixes this box to `centre` ± 1 (times `scale`) by two more discs of radius 1/8.
inline sim::Disc disc_at_cells(RandomSequence& random, const glm::dvec3& centre, double scale) {
  const auto on_plane = [&](double x) { return std::floor(8 * x) / 4 - 1 + random.rounding_offset() * 1e2; };
  sim::Disc disc;
  disc.radius = scale * std::min(0.125, random.magnitude(-4, 0));
  disc.normal = random.normal();
  glm::dvec3 place{random.between(-0.9, 0.9), random.between(-0.9, 0.9), random.between(-0.9, 0.9)};
  for (int axis = 0; axis < 3; ++axis)
    if (random.one_in(1.5)) place[axis] = on_plane(random.between(0.1, 0.9));
  disc.centre = centre + scale * place;
  if (random.one_in(2)) {
    const auto [u, v] = sim::basis_around(disc.normal);
    const double angle = random.between(0, 2 * std::numbers::pi);
    disc.centre -= disc.radius * (std::cos(angle) * u + std::sin(angle) * v);
  }
  return disc;
}

/// Ray number i is a hard_ray for disc number i modulo the number of discs.
inline HardScene hard_scene(std::size_t family_number, std::uint64_t index, std::size_t discs, std::size_t rays) {
  const Family& family = families[family_number];
  RandomSequence random(200 + family_number, index);
  const glm::dvec3 centre = family.scale * family.offset * glm::dvec3{1, -0.25, 0.5};
  HardScene scene;
  for (const double side : {-0.875, 0.875})
    scene.discs.push_back({centre + family.scale * side, random.normal(), family.scale / 8});
  while (scene.discs.size() < discs) scene.discs.push_back(disc_at_cells(random, centre, family.scale));
  for (std::size_t i = 0; i < rays; ++i) scene.rays.push_back(hard_ray(family, random, scene.discs[i % discs]));
  return scene;
}

/// Discs that touch an edge of their own bounding box, and rays that touch the disc there or just miss it. No bounding
/// volume of such a disc may be even slightly too small.
inline HardScene scene_at_corners(std::uint64_t index, std::size_t discs, std::size_t rays) {
  RandomSequence random(400, index);
  HardScene scene;
  std::vector<glm::dvec3> ends;  // points where a disc touches its box
  for (const double side : {-0.875, 0.875})
    scene.discs.push_back({glm::dvec3{side}, {0, 0, 1}, 0.125}), ends.push_back({1, 0, 0});
  while (scene.discs.size() < discs) {
    const int axis = static_cast<int>(3 * random.uniform());
    const double angle = random.between(0, 2 * std::numbers::pi);
    glm::dvec3 normal{0.0};
    glm::dvec3 end{0.0};
    normal[axis] = std::cos(angle), normal[(axis + 1) % 3] = std::sin(angle);
    end[axis] = -std::sin(angle), end[(axis + 1) % 3] = std::cos(angle);
    const glm::dvec3 centre{random.between(-0.9, 0.9), random.between(-0.9, 0.9), random.between(-0.9, 0.9)};
    scene.discs.push_back({centre, glm::normalize(normal), std::min(0.125, random.magnitude(-3, 0))});
    ends.push_back(end);
  }
  for (std::size_t i = 0; i < rays; ++i) {
    const sim::Disc& disc = scene.discs[i % discs];
    const double place = disc.radius * (1 - random.sign() * random.magnitude(-17, -7));
    const glm::dvec3 direction = glm::normalize(random.direction());
    const double from = random.magnitude(-2, 0.5);
    sim::Ray ray{.origin = disc.centre + random.sign() * place * ends[i % discs] - from * direction,
                 .direction = direction};
    if (random.one_in(2)) ray.length = random.one_in(2) ? from * (1 + random.rounding_offset()) : 2 * from;
    scene.rays.push_back(ray);
  }
  return scene;
}

}  // namespace detp::support
