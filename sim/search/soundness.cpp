#include "soundness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/parallel.hpp"
#include "detp/sim/geometry/directions.hpp"

namespace detp::sim {
namespace {

constexpr std::size_t items_at_once = std::size_t{1} << 14;

bool surely_sound(const Ray& ray, double most_power) {
  return surely_in_range(ray.origin) && surely_unit(ray.direction) && ray.length > 0 && ray.power >= 0 &&
         ray.power <= most_power;
}

void require_coordinates(const std::string& what, const glm::dvec3& point) {
  for (int axis = 0; axis < 3; ++axis) {
    require_finite(what, point[axis]);
    if (std::abs(point[axis]) > largest_coordinate)
      throw std::invalid_argument(fmt::format("{} must be within 1e100 of zero (got {})", what, point[axis]));
  }
}

void require_non_zero(const std::string& what, const glm::dvec3& vector) {
  for (int axis = 0; axis < 3; ++axis) require_finite(what, vector[axis]);
  if (vector == glm::dvec3{0})
    throw std::invalid_argument(fmt::format("{} must be non-zero (got {} {} {})", what, vector.x, vector.y, vector.z));
}

/// Throws std::invalid_argument with the ray's number and the reason if the ray is invalid.
void refuse_unsound(const Ray& ray, std::uint64_t number, double most_power) {
  const std::string who = fmt::format("ray {}: ", number);
  require_coordinates(who + "origin", ray.origin);
  require_non_zero(who + "direction", ray.direction);
  if (!ray.is_line()) require_positive(who + "length", ray.length);
  require_non_negative(who + "power", ray.power);
  if (ray.power > most_power)
    throw std::invalid_argument(
        fmt::format("{}power must be at most {:.4g}, or irradiance overflows (got {})", who, most_power, ray.power));
}

void refuse_unsound(const Disc& disc, std::uint64_t number) {
  const std::string who = fmt::format("disc {}: ", number);
  require_coordinates(who + "centre", disc.centre);
  require_non_zero(who + "normal", disc.normal);
  require_positive(who + "radius", disc.radius);
  if (disc.radius < least_radius || disc.radius > largest_coordinate)
    throw std::invalid_argument(
        fmt::format("{}radius must be from 1e-100 to 1e100, or its square overflows (got {})", who, disc.radius));
}

/// Joins what extent_of finds in parts of the rays or discs.
template <class Extent, class Of>
Extent extent_in_parts(std::size_t size, const StopCheck& stop, const Of& of) {
  return sim::parallel_reduce(
      ParallelRange(0, size, items_at_once), Extent{},
      [&](const ParallelRange& range, Extent extent) {
        StopCheck check = stop;
        for (std::size_t first = range.begin(); first < range.end(); first += items_at_once) {
          const std::size_t count = std::min(items_at_once, range.end() - first);
          check.after(count);
          extent = joined(extent, of(first, count));
        }
        check.now();
        return extent;
      },
      [](const Extent& a, const Extent& b) { return joined(a, b); });
}

/// A copy with unit directions or normals.
template <class T>
std::shared_ptr<const std::vector<T>> normalised_copy(std::span<const T> given, StopCheck& check) {
  auto unit = std::make_shared<std::vector<T>>();
  unit->reserve(given.size());
  for_each_checked(given, check, [&](const T& one) { unit->push_back(normalised(one)); });
  return unit;
}

/// A copy with unit directions; null if all directions have unit length. Checks each ray fully: the fast tests have
/// left at least one ray in doubt.
std::shared_ptr<const std::vector<Ray>> normalised_if_needed(std::span<const Ray> rays, double most_power,
                                                             std::uint64_t first, StopCheck check) {
  bool all_unit = true;
  for_each_checked(0, rays.size(), check, [&](std::size_t i) {
    all_unit = all_unit && surely_unit(rays[i].direction);
    if (!surely_sound(normalised(rays[i]), most_power)) refuse_unsound(rays[i], first + i, most_power);
  });
  if (all_unit) return nullptr;
  return normalised_copy(rays, check);
}

}  // namespace

Ray normalised(Ray ray) {
  ray.direction = normalised(ray.direction);
  return ray;
}

Disc normalised(Disc disc) {
  disc.normal = normalised(disc.normal);
  return disc;
}

void require_number(const char* what, std::uint64_t count) {
  if (count == 0) throw std::invalid_argument(fmt::format("there must be at least one {}", what));
  if (count >= UINT32_MAX)
    throw std::length_error(fmt::format("{} {}s are too many; the maximum is 4294967294", count, what));
}

void require_sound(std::span<const Disc> discs, StopCheck& check, std::uint64_t first) {
  for_each_checked(0, discs.size(), check, [&](std::size_t i) {
    if (!surely_sound(discs[i]) && !surely_sound(normalised(discs[i]))) refuse_unsound(discs[i], first + i);
  });
}

std::shared_ptr<const std::vector<Disc>> normalised_if_needed(std::span<const Disc> discs, StopCheck& check) {
  bool all_unit = true;
  for_each_checked(discs, check, [&](const Disc& disc) { all_unit = all_unit && surely_unit(disc.normal); });
  if (all_unit) return nullptr;
  return normalised_copy(discs, check);
}

DiscExtent check_discs(std::span<const Disc> discs, StopCheck check) {
  const auto extent = extent_in_parts<DiscExtent>(discs.size(), check, [&](std::size_t first, std::size_t count) {
    return extent_of(discs.subspan(first, count));
  });
  if (!extent.sound) require_sound(discs, check);
  return extent;
}

Sphere sphere_around(const DiscExtent& extent) {
  const glm::dvec3 centre = extent.centres.centre();
  // The distance of the farther corner, as computed: half the diagonal can be an ulp shorter.
  const double reach = std::max(glm::distance(centre, extent.centres.low), glm::distance(centre, extent.centres.high));
  return {centre, (reach + extent.largest) * (1 + 1e-15)};
}

CheckedRays check_rays(std::span<const Ray> rays, const glm::dvec3& centre, double most_power, std::uint64_t first,
                       const StopCheck& check) {
  const auto extent = extent_in_parts<RayExtent>(rays.size(), check, [&](std::size_t first_ray, std::size_t count) {
    return extent_of(rays.subspan(first_ray, count), centre, most_power);
  });
  CheckedRays checked{.farthest = std::sqrt(extent.farthest2),
                      .one_power = extent.least_power == extent.most_power,
                      .largest_power = extent.most_power,
                      .segments = extent.least_length < unbounded};
  if (!extent.sound) checked.unit = normalised_if_needed(rays, most_power, first, check);
  return checked;
}

void require_one_each(const char* what, std::size_t size, std::size_t rays) {
  if (size != 0 && size != rays)
    throw std::invalid_argument(fmt::format("there are {} {} for {} rays; each ray needs one", size, what, rays));
}

void require_rising(std::uint64_t ray, std::uint64_t photon, std::uint64_t before) {
  if (photon < before)
    throw std::invalid_argument(
        fmt::format("ray {}: its photon has the number {}, after {}; numbers must not fall", ray, photon, before));
}

void check_paths(const PathRays& paths, std::uint64_t first, StopCheck& check) {
  require_one_each("photon numbers", paths.photons.size(), paths.rays.size());
  require_one_each("landings", paths.landings.size(), paths.rays.size());
  require_one_each("triangles", paths.triangles.size(), paths.rays.size());
  std::uint64_t before = 0;
  for_each_checked(0, paths.photons.size(), check, [&](std::size_t i) {
    require_rising(first + i, paths.photons[i], before);
    before = paths.photons[i];
  });
  constexpr std::uint64_t most = std::uint64_t{1} << 62;
  if (before >= most) throw std::invalid_argument(fmt::format("photon numbers must be below 2^62 (got {})", before));
  for_each_checked(0, paths.landings.size(), check, [&](std::size_t i) {
    if (!(paths.landings[i] >= 0))
      throw std::invalid_argument(
          fmt::format("ray {}: landing must be >= 0, or inf for none (got {})", first + i, paths.landings[i]));
  });
}

namespace {

/// Throws for the first malformed power of the rays from `start` on.
[[noreturn]] void refuse_further(const FurtherPowers& all, std::size_t start, double most_power, std::uint64_t first) {
  for (std::size_t i = start * all.bands;; ++i)
    if (!(all.values[i] >= 0 && all.values[i] <= most_power))
      throw std::invalid_argument(fmt::format("ray {}: power of band {} must be 0 to {:.3g} (got {})",
                                              first + i / all.bands, i % all.bands + 1, most_power, all.values[i]));
}

}  // namespace

PowerRange check_further(const PathRays& paths, double most_power, std::uint64_t first, StopCheck& check) {
  const FurtherPowers& all = paths.further;
  if (all.bands >= most_bands)
    throw std::invalid_argument(fmt::format("{} bands are too many; the maximum is {}", all.bands + 1, most_bands));
  if (all.values.size() != all.bands * paths.rays.size())
    throw std::invalid_argument(fmt::format("there are {} powers of {} further bands for {} rays", all.values.size(),
                                            all.bands, paths.rays.size()));
  PowerRange range{std::vector<double>(all.bands), true};
  if (all.bands == 0) return range;
  // Chunks without branches, which the compiler turns into vectors.
  const std::size_t at_once = std::max<std::size_t>(1, 4096 / all.bands);
  const double* const of_first = all.values.data();
  std::array<double, most_bands> largest{};
  for (std::size_t start = 0; start < paths.rays.size(); start += at_once) {
    const std::size_t end = std::min(paths.rays.size(), start + at_once);
    check.after(end - start);
    bool unequal = false;
    bool sound = true;
    for (std::size_t ray = start; ray < end; ++ray) {
      const double* const powers = of_first + ray * all.bands;
      for (std::size_t band = 0; band < all.bands; ++band) {
        const double power = powers[band];
        sound = sound & (power >= 0) & (power <= most_power);
        largest[band] = std::max(largest[band], power);
        unequal = unequal | (power != of_first[band]);
      }
    }
    range.all_equal = range.all_equal && !unequal;
    if (!sound) refuse_further(all, start, most_power, first);
  }
  std::copy_n(largest.begin(), all.bands, range.largest.begin());
  return range;
}

}  // namespace detp::sim
