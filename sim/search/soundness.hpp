#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/geometry.hpp"

/// What make_problem accepts, and how it makes directions and normals unit. All throw Stopped on a stop request.
namespace detp::sim {

/// No disc is smaller: squares must not underflow.
inline constexpr double least_radius = 1e-100;

/// Throws std::invalid_argument, with the disc's number, for a number that is not finite, a coordinate or radius beyond
/// 1e100, a radius below 1e-100, and a normal of length 0. Normals may have any other length.
void require_sound(std::span<const Disc> discs, StopCheck& check);

/// A copy of the discs with unit normals; null if all are unit to 1e-12. Throws as require_sound does.
[[nodiscard]] std::shared_ptr<const std::vector<Disc>> normalised_if_needed(std::span<const Disc> discs,
                                                                            StopCheck& check);

/// What check_rays finds out.
struct CheckedRays {
  double farthest = 0;                                ///< distance of the farthest origin from the centre
  bool one_power = false;                             ///< all carry the same power
  bool segments = false;                              ///< one of them ends
  std::shared_ptr<const std::vector<Ray>> unit = {};  ///< copies with unit directions; null if all were unit to 1e-12
};

/// Checks the rays, on all threads of oneTBB's arena. The first of them is number `first`, for messages.
/// Throws std::invalid_argument, with the ray's number, for a number that is not finite (of lengths: but +infinity), a
/// coordinate beyond 1e100, a direction of length 0, a length <= 0, and a power that is negative or above most_power.
[[nodiscard]] CheckedRays check_rays(std::span<const Ray> rays, const glm::dvec3& centre, double most_power,
                                     std::uint64_t first, const StopCheck& check);

}  // namespace detp::sim
