#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/paths.hpp"
#include "extents.hpp"

/// The checks of make_problem, and its normalisation of directions and normals. All throw Stopped, except normalised().
namespace detp::sim {

/// Lower bound on disc radii, so that squares do not underflow.
inline constexpr double least_radius = 1e-100;

/// Largest distance from 1 of the square of a vector whose length is certainly 1 to within 1e-12; has a margin for rounding.
inline constexpr double unit_tolerance = 1.99e-12;

/// Fast test: true only if the length is certainly 1 to within 1e-12. False for NaN.
[[nodiscard]] inline bool surely_unit(const glm::dvec3& vector) {
  return std::abs(glm::dot(vector, vector) - 1) <= unit_tolerance;
}

/// Fast test with the vector's square: true only if all coordinates are certainly at most largest_coordinate. False for
/// NaN.
[[nodiscard]] inline bool surely_in_range(const glm::dvec3& vector) {
  return glm::dot(vector, vector) <= largest_coordinate * largest_coordinate;
}

/// Fast test: true only if the disc is valid and its normal has unit length.
[[nodiscard]] inline bool surely_sound(const Disc& disc) {
  return surely_in_range(disc.centre) && surely_unit(disc.normal) && disc.radius >= least_radius &&
         disc.radius <= largest_coordinate;
}

/// The vector scaled to unit length. Unchanged if its length is 1 to within 1e-12, or 0.
[[nodiscard]] inline glm::dvec3 normalised(const glm::dvec3& vector) {
  return surely_unit(vector) ? vector : unit_or_zero(vector);
}
/// Returns the ray or disc with a unit direction or normal. Unchanged if the length is 1 to within 1e-12, or 0.
[[nodiscard]] Ray normalised(Ray ray);
[[nodiscard]] Disc normalised(Disc disc);

/// Throws std::invalid_argument for 0, and std::length_error for more than 2³² - 2.
void require_number(const char* what, std::uint64_t count);

/// The first disc is number `first` in messages. Throws std::invalid_argument, with the disc's number, for a number that is not finite, a coordinate or radius beyond
/// 1e100, a radius below 1e-100, and a normal of length 0. Normals may have any other length.
void require_sound(std::span<const Disc> discs, StopCheck& check, std::uint64_t first = 0);

/// Checks the discs on all threads of the caller's arena, by the fast tests and if need be by require_sound.
[[nodiscard]] DiscExtent check_discs(std::span<const Disc> discs, StopCheck check);

/// The sphere that is documented at enclosing_sphere.
[[nodiscard]] Sphere sphere_around(const DiscExtent& extent);

/// A copy of the discs, which are sound, with unit normals; null if all have unit length to within 1e-12.
[[nodiscard]] std::shared_ptr<const std::vector<Disc>> normalised_if_needed(std::span<const Disc> discs,
                                                                            StopCheck& check);

/// The results of check_rays.
struct CheckedRays {
  double farthest = 0;     ///< distance of the farthest origin from the centre
  bool one_power = false;  ///< all rays carry the same power
  double largest_power = 0;
  bool segments = false;  ///< at least one ray is a segment
  /// copies with unit directions; null if all directions have unit length to within 1e-12
  std::shared_ptr<const std::vector<Ray>> unit = {};
};

/// Checks the rays, on all threads of the caller's arena. The first ray is number `first` in messages. Throws
/// std::invalid_argument, with the ray's number, for a number that is not finite (except a length of +infinity), a
/// coordinate beyond 1e100, a direction of length 0, a length <= 0, and a power that is negative or above most_power.
[[nodiscard]] CheckedRays check_rays(std::span<const Ray> rays, const glm::dvec3& centre, double most_power,
                                     std::uint64_t first, const StopCheck& check);

/// Throws std::invalid_argument if an array that is not empty has another length than that of the rays.
void require_one_each(const char* what, std::size_t size, std::size_t rays);

/// Throws std::invalid_argument, with the ray's number, if its photon's number is below that of the ray before it.
void require_rising(std::uint64_t ray, std::uint64_t photon, std::uint64_t before);

/// Throws std::invalid_argument, with the ray's number, for a photon number below the one before it, for a landing that is
/// < 0 or NaN, and for arrays of other lengths than that of the rays.
void check_paths(const PathRays& paths, std::uint64_t first, StopCheck& check);

/// Of the rays' powers in further bands.
struct PowerRange {
  std::vector<double> largest;  ///< of each band
  bool all_equal = true;        ///< all rays carry the same powers
};

/// Throws std::invalid_argument for powers that are negative, above most_power or not finite, with the numbers of ray and band; for another number
/// of powers than the rays need, and for too many bands.
[[nodiscard]] PowerRange check_further(const PathRays& paths, double most_power, std::uint64_t first, StopCheck& check);

}  // namespace detp::sim
