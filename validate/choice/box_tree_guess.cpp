#include "box_tree_guess.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/model/vocabulary/ray_blocks.hpp"

namespace detp::validate {
namespace {

bool crosses_sphere(const sim::Ray& ray, const sim::Disc& disc) {
  const glm::dvec3 to_centre = disc.centre - ray.origin;
  double along = glm::dot(to_centre, ray.direction);
  if (!ray.is_line()) along = std::clamp(along, 0.0, ray.length);
  const glm::dvec3 apart = to_centre - along * ray.direction;
  return glm::dot(apart, apart) <= disc.radius * disc.radius;
}

}  // namespace

BoxTreeParameters usual_shape(double rays, double discs, double placing) {
  require_count("number of rays", rays, 1, 1e18);
  require_count("number of discs", discs, 1, 1e18);
  if (std::isnan(placing))
    throw std::invalid_argument("the ratio of the times for placing and testing must be a number");
  constexpr double least = 3;  // powers of two
  constexpr double most = 9;
  const double power = std::clamp(std::log2(24) + 0.3 * std::log2(discs / rays) +
                                      0.35 * std::log2(std::clamp(placing, 1.0, 1024.0) / usual_placing),
                                  least, most);
  return {8, 1 << std::lround(power)};
}

Counts<double> least_box_tree_counts(const sim::Problem& problem, std::span<const sim::Ray> sample, double rays) {
  constexpr std::size_t most_discs = 64;
  constexpr std::size_t most_rays = 128;
  const std::span<const sim::Disc> discs = problem.discs();
  const std::size_t tried_discs = std::min(most_discs, discs.size());
  const std::size_t tried_rays = std::min(most_rays, sample.size());
  const RayBlocks blocks = ray_blocks(rays, static_cast<double>(discs.size()), Engine::simd);
  double shares = 0;
  double visits = 0;
  for (std::size_t i = 0; i < tried_discs; ++i) {
    const sim::Disc& disc = discs[i * discs.size() / tried_discs];
    std::size_t crossing = 0;
    for (std::size_t k = 0; k < tried_rays; ++k)
      crossing += crosses_sphere(sample[k * sample.size() / tried_rays], disc) ? 1 : 0;
    const double share = static_cast<double>(crossing) / static_cast<double>(tried_rays);
    shares += share;
    visits += blocks.with_any(share);
  }
  const double each = static_cast<double>(discs.size()) / static_cast<double>(tried_discs);
  const bool segments = std::any_of(sample.begin(), sample.end(), [](const sim::Ray& ray) { return !ray.is_line(); });
  return {.loaded = rays,
          .segments = segments ? rays : 0,
          .visits = each * visits,
          .disc_tests = each * shares * rays,
          .placements = static_cast<double>(discs.size()),
          .sorted = static_cast<double>(discs.size())};
}

}  // namespace detp::validate
