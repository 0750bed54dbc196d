#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "hard_geometry.hpp"

/// Scenes of hard rays and discs, for all techniques.
namespace detp::support {

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
