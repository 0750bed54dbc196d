#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include "detp/sim/geometry/random.hpp"
#include "lights.hpp"
#include "ray_caster.hpp"
#include "scatter.hpp"

namespace detp::sim {

/// A caster for photons in this scene. Throws as PhotonWalk.
[[nodiscard]] std::shared_ptr<const RayCaster> caster_for(const Scene& scene, const std::stop_token& stop = {});

/// Walks photons through a scene. Each photon is a function of the seed and its number alone. Several threads may use
/// one walk.
class PhotonWalk {
 public:
  static constexpr std::uint64_t most_pieces = 1000;  ///< per photon, so that walks without absorption terminate

  /// Throws std::invalid_argument for a scene in which photons cannot be traced, std::runtime_error if Embree fails,
  /// and Stopped if a stop was requested.
  PhotonWalk(const Scene& scene, std::uint64_t seed, const std::stop_token& stop = {});
  /// The same, with a caster of the scene's mesh that was made before.
  PhotonWalk(const Scene& scene, std::uint64_t seed, std::shared_ptr<const RayCaster> caster);

  /// In scene units, in place of the scene's.
  void set_overshoot(double length) { overshoot_ = length / caster_->scale(); }

  /// Power of photon number `photon`.
  [[nodiscard]] double power(std::uint64_t photon) const { return lights_.power(photon); }

  /// Walks photon number `photon` and tells the recorder, in order, of
  ///   piece(ray, landing): a straight piece of the path, as photon_paths describes, with the photon's power; `landing` is
  ///     the distance from the ray's origin to the surface that the photon met, `unbounded` if it met none;
  ///   met(triangle, power, absorbed): the surface where the piece ends;
  /// and at last, unless a surface absorbed it, of escaped(power) or cut_off(power).
  template <class Recorder>
  void follow(std::uint64_t photon, Recorder& recorder) const {
    auto [from, power] = lights_.photon(photon, uniform4(seed_, Stream::photons, photon));
    from.origin = caster_->to_caster(from.origin);
    for (std::uint64_t bounce = 1; bounce <= most_pieces; ++bounce) {
      const auto hit = caster_->first_intersection(from.origin, from.direction, from.triangle);
      if (!hit) {
        if (const double distance = distance_out(from); distance > 0)
          recorder.piece(piece(from, distance, 0, power), unbounded);
        return recorder.escaped(power);
      }
      const auto next = scattered(materials_.of(hit->triangle), hit->normal, from.direction,
                                  uniform4(seed_, Stream::photons, photon, bounce));
      const bool passes = next && glm::dot(*next, hit->normal) * glm::dot(from.direction, hit->normal) > 0;
      const glm::dvec3 end = from.origin + hit->distance * from.direction;
      const double beyond = passes ? gap_ : overshoot(end, from.direction, hit->triangle);
      recorder.piece(piece(from, hit->distance, beyond, power), landing(hit->distance));
      recorder.met(hit->triangle, power, !next);
      if (!next) return;
      from = {end, *next, hit->triangle};
    }
    recorder.cut_off(power);
  }

 private:
  [[nodiscard]] Ray piece(const PhotonStart& from, double distance, double beyond, double power) const;
  [[nodiscard]] double start(double distance) const { return std::min(gap_, 0.5 * distance); }
  [[nodiscard]] double landing(double distance) const { return caster_->scale() * (distance - start(distance)); }
  [[nodiscard]] double distance_out(const PhotonStart& from) const;
  [[nodiscard]] double overshoot(const glm::dvec3& end, const glm::dvec3& direction, std::uint32_t triangle) const;

  std::shared_ptr<const RayCaster> caster_;
  Lights lights_;
  Materials materials_;
  std::uint64_t seed_;
  double reach_ = 0;  ///< radius of the sphere around the box at which photons leave, in the caster's own units
  double gap_ = 0;    ///< in the caster's own units
  double overshoot_;  ///< in the caster's own units
};

}  // namespace detp::sim
