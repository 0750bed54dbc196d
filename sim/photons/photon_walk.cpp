#include "photon_walk.hpp"

#include <stdexcept>
#include <utility>

#include "detp/model/vocabulary/checks.hpp"

namespace detp::sim {
namespace {

/// Checks the scene first, so that no later code need handle scenes that cannot be traced.
const Scene& checked(const Scene& scene) {
  if (scene.lights.empty()) throw std::invalid_argument("photon paths need a light; " + scene.name + " has none");
  if (scene.mesh.triangles.empty())
    throw std::invalid_argument("photon paths need triangles; " + scene.name + " has none");
  check(scene.mesh.materials, scene.mesh.triangles.size());
  if (scene.box.empty())
    throw std::invalid_argument("photon paths need the scene's box; that of " + scene.name + " is empty");
  if (!(scene.overshoot >= 0))
    throw std::invalid_argument("photon paths cannot go on beyond surfaces by " + std::to_string(scene.overshoot));
  const glm::dvec3 size = scene.box.size();
  require_positive("diagonal of the scene's box", std::hypot(size.x, size.y, size.z));
  return scene;
}

}  // namespace

std::shared_ptr<const RayCaster> caster_for(const Scene& scene, const std::stop_token& stop) {
  return std::make_shared<const RayCaster>(checked(scene).mesh, scene.box, stop);
}

PhotonWalk::PhotonWalk(const Scene& scene, std::uint64_t seed, const std::stop_token& stop)
    : PhotonWalk(scene, seed, caster_for(scene, stop)) {}

PhotonWalk::PhotonWalk(const Scene& scene, std::uint64_t seed, std::shared_ptr<const RayCaster> caster)
    : caster_(std::move(caster)),
      lights_(checked(scene)),
      materials_(scene.mesh.materials),
      seed_(seed),
      overshoot_(scene.overshoot / caster_->scale()) {
  if (scene.rgb && materials_.all.empty()) materials_.all = {matt};
  for (std::size_t i = 0; scene.rgb && i < materials_.all.size(); ++i)
    colours_.push_back(colours_of(materials_.all[i]));
  const glm::dvec3 size = scene.box.size() / caster_->scale();
  reach_ = glm::length(size);
  gap_ = gap_share * reach_;
}

bool PhotonWalk::is_missed_backwards(std::uint64_t photon) const {
  if (lights_.has_extent(photon)) return false;
  const PhotonStart from = lights_.photon(photon, uniform4(seed_, Stream::photons, photon)).start;
  const auto hit = caster_->first_intersection(caster_->to_caster(from.origin), from.direction, from.triangle);
  if (!hit) return false;
  const Side side = side_met(materials_, hit->triangle, hit->normal, from.direction);
  return uniform4(seed_, Stream::photons, photon, 1)[0] >= side.material.diffuse;
}

/// Distance to where a photon leaves the scene; 0 if it starts outside.
double PhotonWalk::distance_out(const PhotonStart& from) const {
  const double along = glm::dot(from.origin, from.direction);
  const double inside = reach_ * reach_ - glm::dot(from.origin, from.origin);
  return inside > 0 ? std::sqrt(along * along + inside) - along : 0;
}

/// How far a piece goes on beyond the surface where it ends.
double PhotonWalk::overshoot(const glm::dvec3& end, const glm::dvec3& direction, std::uint32_t triangle) const {
  if (overshoot_ <= gap_) return gap_;
  const auto next = caster_->first_intersection(end, direction, triangle, overshoot_ + gap_);
  if (!next) return std::max(gap_, std::min(overshoot_, distance_out({end, direction})));
  if (overshoot_ == unbounded) return next->distance + gap_;
  return std::min(overshoot_, std::max(next->distance - gap_, 0.5 * next->distance));
}

Ray PhotonWalk::piece(const PhotonStart& from, double distance, double beyond, double power) const {
  return {.origin = caster_->to_scene(from.origin + start(distance) * from.direction),
          .direction = from.direction,
          .length = caster_->scale() * (distance - start(distance) + beyond),
          .power = power};
}

}  // namespace detp::sim
