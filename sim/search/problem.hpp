#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/geometry/geometry.hpp"

namespace detp::sim {

/// The rays and the discs, made by make_problem. Borrowed: both must outlive every call that takes the problem.
struct Problem {
  std::span<const Ray> rays;
  std::span<const Disc> discs;
  Sphere enclosing{};         ///< S₀: holds every disc whole; rays may start or pass outside it
  bool front_facing = false;  ///< count only rays that arrive at a disc's front
  double slack = 0;           ///< added to every cull, length: no hit comes so far from its disc (make_problem)
  double farthest = 0;        ///< no ray's origin is farther from the centre of S₀
  double most_power = 0;      ///< no ray carries more, so that no sum and no irradiance overflows
  bool one_power = false;     ///< all rays carry the same power
  bool segments = false;      ///< one of the rays ends
  /// What `rays` or `discs` name where directions or normals had to be normalised; null otherwise.
  std::shared_ptr<const std::vector<Ray>> own_rays = {};
  std::shared_ptr<const std::vector<Disc>> own_discs = {};
};

/// The smallest sphere around the box of the discs' centres, plus the largest radius. Throws std::invalid_argument for
/// no discs, for numbers that are not finite, and where the sphere would not be; Stopped on a stop request.
[[nodiscard]] Sphere enclosing_sphere(std::span<const Disc> discs, const std::stop_token& stop = {});

/// A problem with its S₀. Checks rays and discs, and normalises directions and normals.
///
/// Directions and normals may have any length but 0. Where all are unit to 1e-12, the problem borrows them as they are.
/// Where one is not (a direction normalised in floats is off by some 1e-7), the problem holds a copy of the rays or of
/// the discs, 64 and 56 bytes each, in which it is unit: every technique then finds the same hits. A ray's length stays
/// the same: it is a length in scene units, not a multiple of the direction's. To save the copy, normalise in doubles.
///
/// Throws std::invalid_argument where there is no ray or no disc, or one is malformed; the message has its number, as
/// in "ray 17: direction must be non-zero (got 0 0 0)". Malformed are: a number that is not finite (except +infinity as
/// a length: the whole line), a coordinate or radius above 1e100, a radius below 1e-100, a direction or normal of
/// length 0, a length <= 0, a power that is negative or above most_power (for radii of 1 or more 9.6e288: more could
/// overflow). Throws std::length_error for 2³² or more rays or discs, and Stopped on a stop request.
///
/// The slack is 16e-12 E + ∛(2d κ²) + 1e-15 M: a ray taken for a hit comes nearer than this to the disc, whatever
/// rounding did, with room for that of the culls (proof: sim/geometry/proofs.md). E is the distance of the farthest
/// ray origin from the farthest point of S₀, d the largest disc radius, κ = 2e-15 E the rounding of a predicate, M the
/// largest coordinate of the centre of S₀. The first term is for directions and normals unit to 1e-12; the second for
/// rays that graze a disc near its rim, where rounding moves the crossing farthest; the third for cells far from the
/// origin.
[[nodiscard]] Problem make_problem(std::span<const Ray> rays, std::span<const Disc> discs, bool front_facing = false,
                                   int threads = 1, const std::stop_token& stop = {});

/// A problem whose rays are still to come, block by block: no origin of theirs is to be farther than `farthest` from
/// the centre of S₀, from which the slack follows. Throws as make_problem does.
[[nodiscard]] Problem make_problem_without_rays(std::span<const Disc> discs, double farthest, bool front_facing = false,
                                                const std::stop_token& stop = {});

/// Puts other rays in the place of a problem's, borrowed. Throws as make_problem does, and std::invalid_argument where
/// one starts too far away. The first ray is number `first` in messages. The problem stays as it is where this throws.
void set_rays(Problem& problem, std::span<const Ray> rays, int threads = 1, std::uint64_t first = 0);

}  // namespace detp::sim
