#include "start_places.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "detp/sim/geometry/closest_point.hpp"

namespace detp::sim {
namespace {

constexpr double inside = 1e-3;   // least weight of a corner
constexpr double in_plane = 0.5;  // least cosine between the normals of sample and triangle
constexpr double alike = 0.9;     // of the best cosine, for other triangles that count

struct Near {
  StartPlace place;
  double cosine;
};

}  // namespace

std::vector<StartPlace> start_places(const RayCaster& caster, const Sample& sample, double reach) {
  const glm::dvec3 at = caster.to_caster(sample.position);
  std::vector<Near> near;
  double best = in_plane;
  caster.visit_near(at, reach, [&](std::uint32_t triangle, const Facet& facet) {
    const glm::dvec3 a = facet.corner - at;
    const glm::dvec3 b = a + facet.first;
    const glm::dvec3 c = a + facet.second;
    glm::dvec3 weights = closest_point_weights(a, b, c);
    if (glm::length(weights.x * a + weights.y * b + weights.z * c) > reach) return;
    const double cosine = std::abs(glm::dot(facet.normal, sample.normal));
    if (cosine < in_plane) return;
    best = std::max(best, cosine);
    weights = glm::max(weights, glm::dvec3(inside));
    weights /= weights.x + weights.y + weights.z;
    near.push_back({{facet.corner + weights.y * facet.first + weights.z * facet.second, triangle}, cosine});
  });
  std::erase_if(near, [&](const Near& one) { return one.cosine < alike * best; });
  if (near.empty()) return {{at}};
  std::ranges::sort(near, {}, [](const Near& one) { return *one.place.triangle; });
  std::vector<StartPlace> places;
  for (const Near& one : near) places.push_back(one.place);
  return places;
}

}  // namespace detp::sim
