#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include "detp/sim/geometry/random.hpp"
#include "light_ledger.hpp"
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
  /// Per photon, so that walks without absorption terminate. In a closed room of albedo 0.9999, 2·10⁻⁶ of the photons have longer paths.
  static constexpr std::uint64_t most_pieces = std::uint64_t{1} << 17;

  /// Throws std::invalid_argument for a scene in which photons cannot be traced, std::runtime_error if Embree fails,
  /// and Stopped if a stop was requested.
  PhotonWalk(const Scene& scene, std::uint64_t seed, const std::stop_token& stop = {});
  /// The same, with a caster of the scene's mesh that was made before.
  PhotonWalk(const Scene& scene, std::uint64_t seed, std::shared_ptr<const RayCaster> caster);

  /// In scene units, in place of the scene's.
  void set_overshoot(double length) { overshoot_ = length / caster_->scale(); }

  /// Power of photon number `photon`.
  [[nodiscard]] double power(std::uint64_t photon) const { return lights_.power(photon); }

  /// Whether photon number `photon` comes from a light without extent, and the surface that it meets first is none at which it is
  /// scattered diffusely. Then no backward path finds what it brings to later surfaces (sim/reference/backward_paths.hpp).
  [[nodiscard]] bool is_missed_backwards(std::uint64_t photon) const;

  /// Walks photon number `photon` and tells the recorder, in order, of
  ///   piece(ray, landing): a straight piece of the path, as photon_paths describes, with the photon's power; `landing` is
  ///     the distance from the ray's origin to the surface that the photon met, `unbounded` if it met none;
  ///   met(triangle, power, absorbed): the surface where the piece ends.
  /// Returns how the path ended.
  template <class Recorder>
  PathEnd follow(std::uint64_t photon, Recorder& recorder) const {
    auto [from, power] = lights_.photon(photon, uniform4(seed_, Stream::photons, photon));
    from.origin = caster_->to_caster(from.origin);
    for (std::uint64_t bounce = 1; bounce <= most_pieces; ++bounce) {
      const auto hit = caster_->first_intersection(from.origin, from.direction, from.triangle);
      if (!hit) {
        if (const double distance = distance_out(from); distance > 0)
          recorder.piece(piece(from, distance, 0, power), unbounded);
        return bounce == 1 ? PathEnd::missed : PathEnd::left;
      }
      const Side side = side_met(materials_, hit->triangle, hit->normal, from.direction);
      const auto next =
          scattered(side.material, side.normal, from.direction, uniform4(seed_, Stream::photons, photon, bounce));
      const bool passes = next && glm::dot(*next, hit->normal) * glm::dot(from.direction, hit->normal) > 0;
      const glm::dvec3 end = from.origin + hit->distance * from.direction;
      const double beyond = passes ? gap_ : overshoot(end, from.direction, hit->triangle);
      recorder.piece(piece(from, hit->distance, beyond, power), landing(hit->distance));
      recorder.met(hit->triangle, power, !next);
      if (!next) return PathEnd::absorbed;
      from = {end, *next, hit->triangle};
    }
    return PathEnd::cut;
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
