#include "ray_source.hpp"

#include <algorithm>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/parallel.hpp"

namespace detp::sim {

void RaysInMemory::read(std::uint64_t first, std::span<Ray> block, const std::stop_token&) const {
  std::ranges::copy(rays_.subspan(first, block.size()), block.begin());
}

void RaysInMemory::read_all(std::uint64_t first, std::span<Ray> block, BesideRays& beside,
                            const std::stop_token& stop) const {
  read(first, block, stop);
  const auto powers = further_.from(first).values.first(block.size() * further_.bands);
  beside.further.assign(powers.begin(), powers.end());
}

double RaysInMemory::farthest_from(const glm::dvec3& point) const {
  const DefaultFloatingPoint mode;
  double farthest = 0;
  for (const Ray& ray : rays_) farthest = std::max(farthest, glm::distance(ray.origin, point));
  return farthest;
}

void LinesOfField::read(std::uint64_t first, std::span<Ray> block, const std::stop_token& stop) const {
  constexpr std::size_t lines_at_once = 4096;
  sim::parallel_for(ParallelRange(0, block.size(), lines_at_once), [&](const ParallelRange& range) {
    field_.write(first + range.begin(), block.subspan(range.begin(), range.size()), stop);
  });
}

double LinesOfField::farthest_from(const glm::dvec3& point) const {
  const DefaultFloatingPoint mode;
  constexpr double rounding = 1 + 1e-12;  // errors of the lines' origins and of this formula
  return (glm::distance(sphere_.centre, point) + sphere_.radius + 1e-15 * glm::length(sphere_.centre)) * rounding;
}

}  // namespace detp::sim
