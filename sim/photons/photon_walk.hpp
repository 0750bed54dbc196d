#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

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
  /// Pieces end beyond surfaces by at least this share of the box's diagonal (photon_paths.hpp).
  static constexpr double gap_share = 1e-5;

  /// Throws std::invalid_argument for a scene in which photons cannot be traced, and Stopped if a stop was requested.
  PhotonWalk(const Scene& scene, std::uint64_t seed, const std::stop_token& stop = {});
  /// The same, with a caster of the scene's mesh that was made before.
  PhotonWalk(const Scene& scene, std::uint64_t seed, std::shared_ptr<const RayCaster> caster);

  /// In scene units, in place of the scene's.
  void set_overshoot(double length) { overshoot_ = length / caster_->scale(); }

  /// Rays have powers in three bands (Scene::rgb).
  [[nodiscard]] bool rgb() const { return !colours_.empty(); }

  /// Power of photon number `photon`.
  [[nodiscard]] double power(std::uint64_t photon) const { return lights_.power(photon); }

  /// Whether photon number `photon` comes from a light without extent, and the surface that it meets first is none at which it is
  /// scattered diffusely. Then no backward path finds what it brings to later surfaces (sim/reference/backward_paths.hpp).
  [[nodiscard]] bool is_missed_backwards(std::uint64_t photon) const;

  /// Walks photon number `photon` and tells the recorder, in order, of
  ///   piece(ray, landing): a straight piece of the path, as photon_paths describes, with the photon's power; `landing` is
  ///     the distance from the ray's origin to the surface that the photon met, `unbounded` if it met none;
  ///   met(triangle, power, absorbed): the surface where the piece ends;
  ///   tint(now): if it has this function, before each piece, the share of the photon's power in each of three bands; a last time, 0 if the
  ///     photon was absorbed, after the path.
  /// Returns how the path ended.
  template <class Recorder>
  PathEnd follow(std::uint64_t photon, Recorder& recorder) const {
    auto [from, power] = lights_.photon(photon, uniform4(seed_, Stream::photons, photon));
    glm::dvec3 tint = tint_at_start(photon, from);
    from.origin = caster_->to_caster(from.origin);
    for (std::uint64_t bounce = 1; bounce <= most_pieces; ++bounce) {
      tell(recorder, tint);
      const auto hit = caster_->first_intersection(from.origin, from.direction, from.triangle);
      if (!hit) {
        if (const double distance = distance_out(from); distance > 0)
          recorder.piece(piece(from, distance, 0, power), unbounded);
        return bounce == 1 ? PathEnd::missed : PathEnd::left;
      }
      const Side side = side_met(materials_, hit->triangle, hit->normal, from.direction);
      const Shares shares = shares_of(side.material, tint);
      const auto next = scattered_by(side.material, shares, side.normal, from.direction,
                                     uniform4(seed_, Stream::photons, photon, bounce));
      const bool passes = next && glm::dot(next->direction, hit->normal) * glm::dot(from.direction, hit->normal) > 0;
      const glm::dvec3 end = from.origin + hit->distance * from.direction;
      const double beyond = passes ? gap_ : overshoot(end, from.direction, hit->triangle);
      recorder.piece(piece(from, hit->distance, beyond, power), landing(hit->distance));
      recorder.met(hit->triangle, power, !next);
      tint = next ? tint_after(side.material, shares, next->by, tint) : glm::dvec3(0.0);
      if (!next) tell(recorder, tint);
      if (!next) return PathEnd::absorbed;
      from = {end, next->direction, hit->triangle};
    }
    tell(recorder, tint);
    return PathEnd::cut;
  }

 private:
  [[nodiscard]] Ray piece(const PhotonStart& from, double distance, double beyond, double power) const;
  [[nodiscard]] double start(double distance) const { return std::min(gap_, 0.5 * distance); }
  [[nodiscard]] double landing(double distance) const { return caster_->scale() * (distance - start(distance)); }
  [[nodiscard]] double distance_out(const PhotonStart& from) const;
  [[nodiscard]] double overshoot(const glm::dvec3& end, const glm::dvec3& direction, std::uint32_t triangle) const;

  template <class Recorder>
  static void tell(Recorder& recorder, const glm::dvec3& tint) {
    if constexpr (requires { recorder.tint(tint); }) recorder.tint(tint);
  }
  [[nodiscard]] glm::dvec3 tint_at_start(std::uint64_t photon, const PhotonStart& from) const {
    if (colours_.empty() || !lights_.is_surface(photon)) return glm::dvec3(1.0);
    const Material& material = materials_.of(*from.triangle, !from.on_back);
    return colours_in(material).emitted / material.emitted;
  }
  [[nodiscard]] const Colours& colours_in(const Material& material) const {
    return colours_[static_cast<std::size_t>(&material - materials_.all.data())];
  }
  /// The probabilities by which a photon is scattered: the largest, over the bands, of what it would then have. So its largest weight stays 1
  /// (only where these add up to more than 1, it can be their sum).
  [[nodiscard]] Shares shares_of(const Material& material, const glm::dvec3& tint) const {
    if (colours_.empty()) return {material.diffuse, material.specular, material.glass};
    const auto largest = [&](const glm::dvec3& colour) {
      return std::max({tint.r * colour.r, tint.g * colour.g, tint.b * colour.b});
    };
    const Colours& colours = colours_in(material);
    const Shares shares{largest(colours.diffuse), largest(colours.specular), largest(colours.glass)};
    const double sum = std::max(1.0, shares.diffuse + shares.specular + shares.glass);
    return {shares.diffuse / sum, shares.specular / sum, shares.glass / sum};
  }
  [[nodiscard]] glm::dvec3 tint_after(const Material& material, const Shares& shares, ScatteredBy by,
                                      const glm::dvec3& tint) const {
    if (colours_.empty()) return tint;
    const Colours& colours = colours_in(material);
    return by == ScatteredBy::diffuse    ? tint * colours.diffuse / shares.diffuse
           : by == ScatteredBy::specular ? tint * colours.specular / shares.specular
                                         : tint * colours.glass / shares.glass;
  }

  std::shared_ptr<const RayCaster> caster_;
  Lights lights_;
  Materials materials_;
  std::vector<Colours> colours_;  ///< of each material; empty unless photons have three powers
  std::uint64_t seed_;
  double reach_ = 0;  ///< radius of the sphere around the box at which photons leave, in the caster's own units
  double gap_ = 0;    ///< in the caster's own units
  double overshoot_;  ///< in the caster's own units
};

}  // namespace detp::sim
