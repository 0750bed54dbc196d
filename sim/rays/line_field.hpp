#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"

namespace detp::sim {

/// The line through a sphere with four coordinates in [0, 1): two of its direction, two of its place. Uniform coordinates give uniform
/// isotropic lines (LineField). The line is unbounded, of power 1, and starts at its point nearest to the sphere's centre.
[[nodiscard]] Ray line_at(const Sphere& sphere, const std::array<double, 4>& coordinates);

/// Uniform isotropic random lines through a sphere. Their distribution is the measure μ_ℓ of lines, which no rotation
/// or translation changes.
///
/// A line has a uniform direction. It crosses a uniform point of the disc that lies around the sphere's centre,
/// perpendicular to the line, with the sphere's radius (Santaló, Integral Geometry, II.12). Line i is a function of
/// (seed, i) alone.
class LineField {
 public:
  /// Throws std::invalid_argument unless the radius is > 0, and the radius and the centre's coordinates are at most
  /// 1e100 in absolute value.
  LineField(const Sphere& sphere, std::uint64_t seed);

  /// Line number `index`: unbounded, of power 1. Its origin is its point nearest to the sphere's centre.
  [[nodiscard]] Ray line(std::uint64_t index) const;

  /// Writes the lines from number `first` on: the same as line(i), several at a time. Throws Stopped if a stop was requested.
  void write(std::uint64_t first, std::span<Ray> lines, const std::stop_token& stop = {}) const;

  /// Lines first … first + count - 1. Throws Stopped if a stop was requested.
  [[nodiscard]] std::vector<Ray> lines(std::uint64_t first, std::size_t count, const std::stop_token& stop = {}) const;

 private:
  Sphere sphere_;
  std::uint64_t seed_;
};

}  // namespace detp::sim
