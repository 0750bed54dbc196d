#pragma once

#include <concepts>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geometry.hpp"

namespace detp::sim {

/// Instead of the number of a triangle: the photon met none.
inline constexpr std::uint32_t no_triangle = std::numeric_limits<std::uint32_t>::max();

/// What the rays carry in further bands, beside Ray::power, which is band 0: a row of `bands` powers for each ray. Hits do not depend on
/// powers, so a search finds the irradiance in all bands.
struct FurtherPowers {
  std::span<const double> values = {};
  std::size_t bands = 0;

  [[nodiscard]] std::span<const double> of(std::size_t ray) const { return values.subspan(ray * bands, bands); }
  /// Those of the rays from one on.
  [[nodiscard]] FurtherPowers from(std::size_t ray) const { return {values.subspan(ray * bands), bands}; }
};

/// Bytes of a ray with powers in so many bands.
[[nodiscard]] constexpr std::size_t bytes_of_ray_in(std::size_t bands) {
  return sizeof(Ray) + (bands - 1) * sizeof(double);
}

/// A ray has so many powers at most.
inline constexpr std::size_t most_bands = 64;

/// Rays as pieces of photon paths. What the search for pairs does not need is in arrays of its own, beside the rays.
struct PathRays {
  std::span<const Ray> rays;
  /// Number of each ray's photon. Rays of one photon share its number and follow one another: numbers never fall. Empty:
  /// each ray is a photon of its own.
  std::span<const std::uint64_t> photons = {};
  /// Distance from each ray's origin to the surface that the photon met; `unbounded` if it met none. Empty: each ray's end.
  std::span<const double> landings = {};
  /// Number of the triangle that the photon met there; no_triangle if it met none. Empty: not known.
  std::span<const std::uint32_t> triangles = {};
  FurtherPowers further = {};
  /// Photons emitted, with those that gave no ray. 0: up to the last ray's photon.
  std::uint64_t photon_count = 0;
  double scale = 1;  ///< of the rays' powers in the irradiance

  PathRays() = default;
  /// Rays without photon numbers and landings.
  template <class Rays>
  requires std::convertible_to<const Rays&, std::span<const Ray>> PathRays(const Rays& of) : rays(of) {}
  PathRays(const Ray* first, std::size_t count) : rays(first, count) {}
  PathRays(std::span<const Ray> of, std::span<const std::uint64_t> photon_numbers, std::span<const double> landing,
           std::uint64_t emitted = 0, std::span<const std::uint32_t> triangle = {})
      : rays(of), photons(photon_numbers), landings(landing), triangles(triangle), photon_count(emitted) {}
};

/// The same, with its arrays.
struct Paths {
  std::vector<Ray> rays;
  std::vector<std::uint64_t> photons = {};
  std::vector<double> landings = {};
  std::vector<std::uint32_t> triangles = {};
  std::vector<double> further = {};  ///< as FurtherPowers::values
  std::size_t further_bands = 0;
  std::uint64_t photon_count = 0;
  double scale = 1;

  /// A ray of others with what they have of it, as a piece of the path of `photon`, if they have photons.
  void add(const PathRays& others, std::size_t ray, std::uint64_t photon) {
    rays.push_back(others.rays[ray]);
    if (!others.photons.empty()) photons.push_back(photon);
    if (!others.landings.empty()) landings.push_back(others.landings[ray]);
    if (!others.triangles.empty()) triangles.push_back(others.triangles[ray]);
    further_bands = others.further.bands;
    if (further_bands == 0) return;
    const std::span<const double> powers = others.further.of(ray);
    further.insert(further.end(), powers.begin(), powers.end());
  }

  operator PathRays() const {
    PathRays all(rays, photons, landings, photon_count, triangles);
    all.further = {further, further_bands};
    all.scale = scale;
    return all;
  }
};

}  // namespace detp::sim
