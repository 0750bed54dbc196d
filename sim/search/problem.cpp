#include "problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/threads.hpp"
#include "soundness.hpp"
#include "totals.hpp"

namespace detp::sim {
namespace {

constexpr const char* checking = "checking rays and discs";

/// The largest power for which the sum over 2⁶⁴ rays, also divided by the smallest disc's area, does not overflow.
double most_power_for(double smallest_radius) {
  const double area = std::numbers::pi * smallest_radius * smallest_radius;
  return 0.99 * std::numeric_limits<double>::max() * 0x1p-64 * std::min(1.0, area);
}

/// The slack as documented at make_problem. sim/geometry/proofs.md proves that it is sufficient for every cull.
double cull_slack(const Sphere& enclosing, double farthest, double largest_radius) {
  double offset = 0;
  for (int axis = 0; axis < 3; ++axis) offset = std::max(offset, std::abs(enclosing.centre[axis]));
  const double extent = farthest + enclosing.radius;
  const double rounding = 2e-15;
  // Computed relative to the extent, because the product of three small lengths would underflow.
  const double grazing = std::cbrt(2 * (largest_radius / extent) * rounding * rounding);
  return (16e-12 + grazing) * extent + 1e-15 * offset;
}

/// The root mean square of radii. Their squares cannot overflow or underflow, because they are 1e-100 to 1e100.
double rms_radius(std::span<const Disc> discs, const DiscExtent& extent, StopCheck& check) {
  if (extent.smallest == extent.largest) return extent.largest;
  double squares = 0;
  for_each_checked(discs, check, [&](const Disc& disc) { squares += disc.radius * disc.radius; });
  return std::sqrt(squares / static_cast<double>(discs.size()));
}

}  // namespace

Sphere enclosing_sphere(std::span<const Disc> discs, const std::stop_token& stop) {
  const DefaultFloatingPoint mode;
  require_number("disc", discs.size());
  return sphere_around(check_discs(discs, StopCheck(stop, checking)));
}

Problem::Problem(std::span<const Disc> discs, bool front_facing, int threads, const std::stop_token& stop)
    : front_facing_(front_facing) {
  require_number("disc", discs.size());
  require_count("number of threads", threads, 0, most_threads);
  StopCheck check(stop, checking);
  DiscExtent extent;
  on_threads(thread_count(threads), [&] { extent = check_discs(discs, StopCheck(stop, checking)); });
  if (!extent.sound) own_discs_ = normalised_if_needed(discs, check);
  discs_ = own_discs_ ? std::span<const Disc>(*own_discs_) : discs;
  enclosing_ = sphere_around(extent);
  centres_ = extent.centres;
  radii_ = {.smallest = extent.smallest, .largest = extent.largest, .rms = rms_radius(discs, extent, check)};
  most_power_ = most_power_for(radii_.smallest);
}

double Problem::store_rays(const PathRays& paths, int threads, std::uint64_t first, const std::stop_token& stop) {
  const std::span<const Ray> rays = paths.rays;
  require_number("ray", rays.size());
  require_count("number of threads", threads, 0, most_threads);
  CheckedRays checked;
  on_threads(thread_count(threads),
             [&] { checked = check_rays(rays, enclosing_.centre, most_power_, first, StopCheck(stop, checking)); });
  StopCheck check(stop, checking);
  check_paths(paths, first, check);
  PowerRange further = check_further(paths, most_power_, first, check);
  paths_ = paths;
  one_power_ = checked.one_power && further.all_equal;
  largest_power_ = checked.largest_power;
  largest_further_ = std::move(further.largest);
  segments_ = checked.segments;
  own_rays_ = std::move(checked.unit);
  rays_ = own_rays_ ? std::span<const Ray>(*own_rays_) : rays;
  return checked.farthest;
}

std::size_t Problem::end_of_block(std::size_t first, std::size_t end, std::uint64_t first_photon,
                                  PhotonBlocks blocks) const {
  const std::uint64_t next = blocks.first(blocks.of(photon(first, first_photon)) + 1);
  if (!numbered()) return static_cast<std::size_t>(std::min<std::uint64_t>(end, next - first_photon));
  const auto begin = paths_.photons.begin();
  return static_cast<std::size_t>(
      std::lower_bound(begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(end), next) -
      begin);
}

void Problem::set_farthest(double farthest) {
  if (!(farthest + enclosing_.radius < largest_coordinate))
    throw std::invalid_argument("rays and discs must lie within 1e100 of each other, or their squares overflow");
  farthest_ = farthest;
  slack_ = cull_slack(enclosing_, farthest, radii_.largest);
}

Problem make_problem(const PathRays& rays, std::span<const Disc> discs, bool front_facing, int threads,
                     const std::stop_token& stop) {
  const DefaultFloatingPoint mode;
  Problem problem(discs, front_facing, threads, stop);
  problem.set_farthest(problem.store_rays(rays, threads, 0, stop));
  return problem;
}

Problem make_problem_without_rays(std::span<const Disc> discs, double farthest, bool front_facing,
                                  const std::stop_token& stop) {
  const DefaultFloatingPoint mode;
  Problem problem(discs, front_facing, 1, stop);
  require_non_negative("distance of the farthest ray's origin", farthest);
  problem.set_farthest(farthest);
  return problem;
}

void set_rays(Problem& problem, const PathRays& rays, int threads, std::uint64_t first) {
  const DefaultFloatingPoint mode;
  Problem changed = problem;
  const double farthest = changed.store_rays(rays, threads, first, {});
  if (farthest > problem.farthest())
    throw std::invalid_argument(
        fmt::format("a ray starts {} from the centre of the discs, but the problem was made for at most {}", farthest,
                    problem.farthest()));
  problem = std::move(changed);
}

}  // namespace detp::sim
