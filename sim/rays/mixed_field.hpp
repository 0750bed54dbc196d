#pragma once

#include <cstdint>
#include <span>
#include <stop_token>

#include "line_field.hpp"
#include "ray_source.hpp"

namespace detp::sim {

/// How many of the rays of a mixture are of each kind. The shares are >= 0 and add up to 1.
struct FieldShares {
  double isotropic = 1;    ///< lines of the measure μ_ℓ through the sphere
  double directional = 0;  ///< parallel lines through the sphere
  double point = 0;        ///< segments from a point to where they leave the sphere
};

/// Where a mixture's rays go. Each kind is uniform: parallel lines over the disc in which the sphere appears, directions
/// from the point over all that meet the sphere.
struct FieldMixture {
  Sphere sphere;
  FieldShares shares;
  glm::dvec3 direction{0.0, -1.0, 0.0};  ///< of the parallel lines; any length > 0
  glm::dvec3 point{0.0};                 ///< inside or outside of the sphere, not on it
};

/// Throws std::invalid_argument unless all shares are in [0, 1] and add up to 1 within 1e-9.
void check(const FieldShares& shares);

/// The first `count` rays of a mixture. All have power 1. Ray i is a function of (seed, i) alone: van der Corput's
/// sequence in base 2 decides its kind, so that each stretch of rays has its share of each kind. With a share of 1, the
/// lines have the bytes of LineField.
class MixedField final : public RaySource {
 public:
  /// Throws std::invalid_argument as LineField and check(FieldShares), for a direction that is zero or not finite, and
  /// for a point that is not finite or lies on the sphere within rounding.
  MixedField(const FieldMixture& mixture, std::uint64_t seed, std::uint64_t count);

  [[nodiscard]] std::uint64_t size() const override { return count_; }
  void read(std::uint64_t first, std::span<Ray> block, const std::stop_token& stop = {}) const override;
  [[nodiscard]] double farthest_from(const glm::dvec3& point) const override;

 private:
  [[nodiscard]] Ray ray(std::uint64_t index) const;
  [[nodiscard]] Ray parallel(std::uint64_t index) const;
  [[nodiscard]] Ray from_point(std::uint64_t index) const;

  FieldMixture mixture_;
  LineField lines_;
  std::uint64_t seed_;
  std::uint64_t count_;
  double cap_ = 2;  ///< 1 - cos of the half angle of the cone from the point to the sphere; 2 from inside
};

}  // namespace detp::sim
