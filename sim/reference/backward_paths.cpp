#include "backward_paths.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/parallel.hpp"
#include "detp/sim/geometry/closest_point.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/photons/photon_walk.hpp"
#include "detp/sim/photons/scatter.hpp"
#include "seen_lights.hpp"

namespace detp::sim {
namespace {

constexpr std::uint64_t most_bounces = 1000;  // as a photon has
// Paths that start in glass may never leave it. After so many bounces without a diffuse one, they end by chance.
constexpr int bounces_in_glass = 64;
constexpr double goes_on = 0.98;
constexpr std::uint64_t paths_in_a_round = 64;

/// The random numbers of one path, four for each of its decisions, and the number of rays that it casts.
class PathNumbers {
 public:
  PathNumbers(std::uint64_t seed, std::uint64_t sample, std::uint64_t path, bool front)
      : seed_(seed), path_((sample << 33) | (path << 1) | (front ? 1 : 0)) {}

  std::array<double, 4> next() { return uniform4(seed_, Stream::reference, path_, decision_++); }
  std::uint64_t casts = 0;

 private:
  std::uint64_t seed_;
  std::uint64_t path_;
  std::uint64_t decision_ = 0;
};

}  // namespace

struct BackwardPaths::Walk {
  const Scene& scene;
  std::uint64_t seed;
  std::shared_ptr<const RayCaster> caster;
  SeenLights lights;
  double reach;

  Walk(const Scene& of, std::uint64_t with_seed, std::shared_ptr<const RayCaster> with)
      : scene(of), seed(with_seed), caster(std::move(with)), lights(of) {
    reach = PhotonWalk::gap_share * glm::length(of.box.size()) / caster->scale();
  }

  [[nodiscard]] double irradiance(const std::vector<StartPlace>& places, const Sample& sample, std::uint64_t number,
                                  std::uint64_t path, bool front, std::uint64_t& casts) const {
    PathNumbers numbers(seed, number, path, front);
    const glm::dvec3 normal = front ? sample.normal : -sample.normal;
    const StartPlace& place = places[path % places.size()];
    const double straight = from_light(place, normal, numbers);
    const double sum = straight + from_surfaces(place, normal, numbers);
    casts += numbers.casts;
    return sum;
  }

  /// Straight from one light, on the side of the normal.
  [[nodiscard]] double from_light(const StartPlace& place, const glm::dvec3& normal, PathNumbers& numbers) const {
    const SeenLight light = lights.sample(caster->to_scene(place.point), numbers.next());
    const double cosine = glm::dot(normal, light.direction);
    if (!(cosine > least_cosine && light.irradiance > 0)) return 0;
    if (light.triangle && light.triangle == place.triangle) return 0;
    ++numbers.casts;
    const auto hit = caster->first_intersection(place.point, light.direction, place.triangle);
    constexpr double at_light = 1 - 1e-7;  // of the distance; behind, or on, the light
    const bool free = !hit || (light.triangle && hit->triangle == *light.triangle) ||
                      hit->distance * caster->scale() >= at_light * light.distance;
    if (!free) return 0;
    const double by_path = light.density > 0 ? cosine * std::numbers::inv_pi / light.density : 0;
    return cosine * light.irradiance / (1 + by_path);
  }

  /// π L of a direction by the cosine law.
  [[nodiscard]] double from_surfaces(StartPlace place, const glm::dvec3& normal, PathNumbers& numbers) const {
    const auto first = numbers.next();
    SeenLights::Look look{.direction = cosine_direction(normal, first[0], first[1])};
    look.density = glm::dot(normal, look.direction) * std::numbers::inv_pi;
    double weight = std::numbers::pi;
    double sum = 0;
    int since_diffuse = 0;
    for (std::uint64_t bounce = 0; bounce < most_bounces; ++bounce) {
      look.origin = caster->to_scene(place.point);
      ++numbers.casts;
      const auto hit = caster->first_intersection(place.point, look.direction, place.triangle);
      const double distance = hit ? hit->distance * caster->scale() : unbounded;
      sum += weight * lights.radiance_on_the_way(look, distance);
      if (!hit) return sum + weight * lights.environment();
      sum += weight * lights.radiance_of(hit->triangle, look, distance);
      const Side met = side_met(scene.mesh.materials, hit->triangle, hit->normal, look.direction);
      const Material& material = met.material;
      const auto random = numbers.next();
      const auto next = scattered(material, met.normal, look.direction, random);
      if (!next) return sum;
      const bool on_front = glm::dot(met.normal, look.direction) < 0;
      const glm::dvec3 side = on_front ? met.normal : -met.normal;
      place = {place.point + hit->distance * look.direction, hit->triangle};
      look.direction = *next;
      look.density = unbounded;
      if (++since_diffuse > bounces_in_glass) {
        if (numbers.next()[0] >= goes_on) return sum;
        weight /= goes_on;
      }
      if (random[0] < material.diffuse) {
        since_diffuse = 0;
        sum += weight * std::numbers::inv_pi * from_light(place, side, numbers);
        look.density = glm::dot(side, *next) * std::numbers::inv_pi;
      } else if (glm::dot(*next, side) < 0) {
        weight /= std::pow(on_front ? material.index : 1 / material.index, 2);
      }
    }
    return sum;
  }
};

BackwardPaths::BackwardPaths(const Scene& scene, std::uint64_t seed, const std::stop_token& stop)
    : BackwardPaths(scene, seed, caster_for(scene, stop)) {}

BackwardPaths::BackwardPaths(const Scene& scene, std::uint64_t seed, std::shared_ptr<const RayCaster> caster) {
  const DefaultFloatingPoint mode;
  walk_ = std::make_unique<const Walk>(scene, seed, std::move(caster));
}

BackwardPaths::~BackwardPaths() = default;

double BackwardPaths::irradiance(const Sample& sample, std::uint64_t number, std::uint64_t path, bool front) const {
  std::uint64_t casts = 0;
  return walk_->irradiance(start_places(*walk_->caster, sample, walk_->reach), sample, number, path, front, casts);
}

void BackwardPaths::add(const Sample& sample, std::uint64_t number, std::uint64_t paths, bool front_facing,
                        PathSums& sums) const {
  const std::vector<StartPlace> places = start_places(*walk_->caster, sample, walk_->reach);
  for (; sums.paths < paths; ++sums.paths)
    for (const bool front : {true, false}) {
      if (!front && front_facing) continue;
      const double one = walk_->irradiance(places, sample, number, sums.paths, front, sums.casts);
      (front ? sums.front : sums.back) += one;
      (front ? sums.front_squares : sums.back_squares) += one * one;
      sums.largest = std::max(sums.largest, one);
      sums.lit += one > 0 ? 1 : 0;
    }
}

bool misses_light(const Scene& scene) {
  const bool narrow = std::ranges::any_of(scene.lights, [](const Light& light) {
    const LightKind kind = kind_of(light);
    return kind == LightKind::point || kind == LightKind::spot || kind == LightKind::directional;
  });
  const auto& materials = scene.mesh.materials.all;
  return narrow &&
         std::ranges::any_of(materials, [](const Material& one) { return one.specular > 0 || one.glass > 0; });
}

double PathSums::variance() const {
  const auto n = static_cast<double>(paths);
  const auto of = [n](double sum, double squares) {
    return std::max(0.0, squares / n - sum / n * (sum / n)) / (n - 1);
  };
  return of(front, front_squares) + of(back, back_squares);
}

void add_backward_paths(const BackwardPaths& walk, std::span<const Sample> samples, std::uint64_t paths,
                        bool front_facing, std::span<PathSums> sums, const std::stop_token& stop) {
  sim::parallel_for(ParallelRange(0, samples.size(), 1), [&](const ParallelRange& part) {
    for (std::size_t i = part.begin(); i != part.end(); ++i)
      while (sums[i].paths < paths) {
        if (stop.stop_requested()) return;
        walk.add(samples[i], i, std::min(paths, sums[i].paths + paths_in_a_round), front_facing, sums[i]);
      }
  });
}

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
