#include "photon_tracer.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"

namespace detp::sim {
namespace {

constexpr std::uint64_t most_pieces = 1000;     // per photon, so that an albedo of 1 terminates
constexpr std::uint64_t work_of_a_bounce = 64;  // for StopCheck: a bounce takes microseconds
constexpr double gap_share = 1e-5;              // share of the box's diagonal

/// Checks the scene first, so that no later code need handle scenes that cannot be traced.
const Scene& checked(const Scene& scene) {
  if (!scene.light) throw std::invalid_argument("photon paths need a light; " + scene.name + " has none");
  if (scene.mesh.triangles.empty())
    throw std::invalid_argument("photon paths need triangles; " + scene.name + " has none");
  if (!(scene.albedo >= 0 && scene.albedo <= 1))
    throw std::invalid_argument("albedo must be in [0, 1] (got " + std::to_string(scene.albedo) + ")");
  if (scene.box.empty())
    throw std::invalid_argument("photon paths need the scene's box; that of " + scene.name + " is empty");
  const glm::dvec3 size = scene.box.size();
  require_positive("diagonal of the scene's box", std::hypot(size.x, size.y, size.z));
  return scene;
}

}  // namespace

PhotonTracer::PhotonTracer(const Scene& scene, std::uint64_t seed, const std::stop_token& stop)
    : caster_(checked(scene).mesh, scene.box, stop), emitter_(*scene.light), albedo_(scene.albedo), seed_(seed) {
  const glm::dvec3 size = scene.box.size() / caster_.scale();
  reach_ = glm::length(size);
  gap_ = gap_share * reach_;
}

PhotonPieces PhotonTracer::trace(std::uint64_t first, std::uint64_t last, const std::stop_token& stop) const {
  StopCheck check(stop, "tracing photons");
  check.now();
  PhotonPieces pieces;
  for (std::uint64_t photon = first; photon < last; ++photon) {
    add_path(photon, pieces.rays);
    const std::size_t bounces = pieces.rays.size() - pieces.photons.size() + 1;
    pieces.photons.resize(pieces.rays.size(), photon);
    check.after(work_of_a_bounce * bounces);
  }
  return pieces;
}

void PhotonTracer::add_path(std::uint64_t photon, std::vector<Ray>& rays) const {
  PhotonStart from = emitter_.photon(uniform4(seed_, Stream::photons, photon));
  from.origin = caster_.to_caster(from.origin);
  std::optional<std::uint32_t> triangle;
  for (std::uint64_t bounce = 1; bounce <= most_pieces; ++bounce) {
    const auto intersection = caster_.first_intersection(from.origin, from.direction, triangle);
    if (!intersection) return add_last_piece(from, rays);
    rays.push_back(piece(from, intersection->distance, gap_));
    const auto random = uniform4(seed_, Stream::photons, photon, bounce);
    if (!(random[0] < albedo_)) return;
    const glm::dvec3 normal =
        glm::dot(intersection->normal, from.direction) < 0 ? intersection->normal : -intersection->normal;
    from.origin += intersection->distance * from.direction;
    from.direction = cosine_direction(normal, random[1], random[2]);
    triangle = intersection->triangle;
  }
}

/// Adds the last piece of a photon that leaves the scene.
void PhotonTracer::add_last_piece(const PhotonStart& from, std::vector<Ray>& rays) const {
  const double along = glm::dot(from.origin, from.direction);
  const double inside = reach_ * reach_ - glm::dot(from.origin, from.origin);
  if (inside > 0) rays.push_back(piece(from, std::sqrt(along * along + inside) - along, 0));
}

Ray PhotonTracer::piece(const PhotonStart& from, double distance, double beyond) const {
  const double start = std::min(gap_, 0.5 * distance);
  return {.origin = caster_.to_scene(from.origin + start * from.direction),
          .direction = from.direction,
          .length = caster_.scale() * (distance - start + beyond)};
}

}  // namespace detp::sim
