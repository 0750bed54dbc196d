#include "self_shadow.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/photons/photon_walk.hpp"
#include "detp/sim/scene/resample.hpp"
#include "detp/sim/technique/technique.hpp"

namespace detp::sim {
namespace {

constexpr std::size_t enough_pieces = 4096;
constexpr std::uint64_t most_photons = 16384;
constexpr std::size_t pilot_discs = 8192;
constexpr double radius_of_pilot = 0.02;  // of the scene's longest side
constexpr double tolerated = 0.01;
constexpr std::uint64_t seed = 1;
constexpr double still_in_plane = 0.05;  // below the surface's plane, in disc radii

/// A piece of a path that goes on through the surface where it ends.
struct LandedAt {
  double distance;    ///< from the piece's start to the surface
  glm::dvec3 normal;  ///< of the surface, on the side from which the photon came
  bool front;         ///< the photon came from the surface's front
};

/// Keeps pieces that end on a surface. PhotonWalk tells of each piece before it tells of its surface.
struct Landings {
  const Mesh& mesh;
  StopCheck check;
  std::vector<Ray> rays = {};
  std::vector<LandedAt> landings = {};

  void piece(const Ray& ray, double) {
    check.after(1024);
    last = ray;
    if (++in_part < pieces_of_part) return;
    parts.push_back(watch.lap() / pieces_of_part);
    in_part = 0;
  }
  void met(std::uint32_t triangle, double, bool) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    const glm::dvec3 corner = mesh.positions[a];
    const glm::dvec3 normal = glm::normalize(glm::cross(mesh.positions[b] - corner, mesh.positions[c] - corner));
    const double cosine = glm::dot(normal, last.direction);
    rays.push_back(last);
    landings.push_back({glm::dot(corner - last.origin, normal) / cosine, cosine < 0 ? normal : -normal, cosine < 0});
  }

  /// Of the middle part: the first finds cold caches, and others may have been interrupted.
  [[nodiscard]] double piece_seconds() {
    if (parts.empty()) return 0;
    const auto middle = parts.begin() + std::ssize(parts) / 2;
    std::nth_element(parts.begin(), middle, parts.end());
    return *middle;
  }

  static constexpr int pieces_of_part = 512;

  Ray last = {};
  Stopwatch watch = {};
  int in_part = 0;
  std::vector<double> parts = {};  ///< seconds for a piece
};

Landings traced(const PhotonWalk& walk, const Mesh& mesh, const std::stop_token& stop) {
  Landings all{mesh, StopCheck(stop, "tracing photons")};
  for (std::uint64_t photon = 0; photon < most_photons && all.rays.size() < enough_pieces; ++photon) {
    walk.follow(photon, all);
    all.check.after(1024);
  }
  return all;
}

/// Power of the hits of one piece.
struct Power {
  double before = 0;  ///< the surface
  double gained = 0;  ///< beyond it, less what comes through sheets
};

std::vector<Power> hits_of(const Landings& all, std::span<const Disc> discs, bool front_facing,
                           const std::stop_token& stop) {
  if (all.rays.empty() || discs.empty()) return std::vector<Power>(all.rays.size());  // no light meets a surface
  const Problem problem = make_problem(all.rays, discs, front_facing, 1, stop);
  RunOptions options{.count = false, .pairs = true, .stop = stop};
  const Outcome outcome = run(problem, Candidate{Technique::box_tree, BoxTreeParameters{}}, options);
  std::vector<Power> power(all.rays.size());
  for (const Pair& pair : outcome.pairs) {
    const Ray& ray = all.rays[pair.ray];
    const Disc& disc = discs[pair.disc];
    const auto& [distance, normal, front] = all.landings[pair.ray];
    const double cosine = glm::dot(ray.direction, disc.normal);
    const double crossing = glm::dot(disc.centre - ray.origin, disc.normal) / cosine;
    if (crossing <= distance + 1e-6 * disc.radius) {
      power[pair.ray].before += ray.power;
      continue;
    }
    const glm::dvec3 landing = ray.origin + distance * ray.direction;
    const bool in_front = glm::dot(disc.centre - landing, normal) > -still_in_plane * disc.radius;
    const bool same_side = (cosine < 0) == front;
    power[pair.ray].gained += in_front && same_side ? ray.power : -ray.power;
  }
  return power;
}

std::vector<Disc> discs_by_area(const Scene& scene, const std::stop_token& stop) {
  std::vector<Sample> samples;
  add_by_area(samples, scene.mesh, pilot_discs, seed, stop);
  std::vector<Disc> discs;
  for (const Sample& sample : samples)
    if (sample.normal != glm::dvec3{0.0})
      discs.push_back({sample.position, sample.normal, radius_of_pilot * scene.box.longest_side()});
  return discs;
}

}  // namespace

double overshoot_for(std::span<const Disc> discs) {
  double largest = 0;
  for (const Disc& disc : discs) largest = std::max(largest, disc.radius);
  return overshoot_over_radius * largest;
}

SelfShadow self_shadow(const Scene& scene, std::shared_ptr<const RayCaster> caster, bool front_facing,
                       const std::stop_token& stop) {
  const std::vector<Disc> discs = discs_by_area(scene, stop);
  PhotonWalk walk(scene, seed, std::move(caster));
  walk.set_overshoot(overshoot_for(discs));
  Landings all = traced(walk, scene.mesh, stop);
  const double piece_seconds = all.piece_seconds();
  double before = 0;
  double gained = 0;
  const std::vector<Power> power = hits_of(all, discs, front_facing, stop);
  for (const Power& one : power) {
    before += one.before;
    gained += one.gained;
  }
  if (!(before > 0)) return {{.value = tolerated}, piece_seconds};
  const double value = gained / before;
  double squares = 0;
  for (const Power& one : power) squares += std::pow(one.gained - value * one.before, 2);
  return {{.value = value + tolerated, .standard_error = std::sqrt(squares) / before}, piece_seconds};
}

}  // namespace detp::sim
