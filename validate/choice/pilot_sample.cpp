#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/model/vocabulary/ray_blocks.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/geometry/ray_box.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "pilot.hpp"

namespace detp::validate {
namespace {

constexpr std::uint64_t sample_seed = 0x5eed;  // not the seed of a run's lines

/// The first `count` lines that cross the box, cut to their chords of box and sphere.
std::vector<sim::Ray> chords(const sim::LineField& lines, const sim::Sphere& sphere, const sim::Box& box,
                             std::size_t count) {
  const std::uint64_t most_tried = 100 * count;  // a flat box is crossed by a few percent of the lines
  std::vector<sim::Ray> found;
  for (std::uint64_t i = 0; i < most_tried && found.size() < count; ++i) {
    sim::Ray ray = lines.line(i);
    sim::RayInterval inside = sim::ClippedRay(ray).inside(box);
    const glm::dvec3 nearest = ray.origin - sphere.centre;  // of the line's points
    const double half = std::sqrt(std::max(0.0, sphere.radius * sphere.radius - glm::dot(nearest, nearest)));
    inside = {std::max(inside.from, -half), std::min(inside.to, half)};
    if (inside.empty() || !(inside.to > inside.from)) continue;
    ray.origin += inside.from * ray.direction;
    ray.length = inside.to - inside.from;
    found.push_back(ray);
  }
  return found;
}

bool crosses_sphere(const sim::Ray& ray, const sim::Disc& disc) {
  const glm::dvec3 to_centre = disc.centre - ray.origin;
  double along = glm::dot(to_centre, ray.direction);
  if (!ray.is_line()) along = std::clamp(along, 0.0, ray.length);
  const glm::dvec3 apart = to_centre - along * ray.direction;
  return glm::dot(apart, apart) <= disc.radius * disc.radius;
}

}  // namespace

double work_of(double rays, double discs) { return discs + 4 * rays; }

std::size_t pilot_size(double rays, double discs) {
  return static_cast<std::size_t>(std::clamp(work_of(rays, discs) / 600, 64.0, 2048.0));
}

std::vector<sim::Ray> pilot_sample(std::span<const sim::Ray> rays, std::size_t discs) {
  const std::size_t enough = pilot_size(static_cast<double>(rays.size()), static_cast<double>(discs));
  std::vector<sim::Ray> sample;
  for (const std::size_t ray : sim::stratified_sample(rays.size(), enough, 1, sim::Stream::pilot))
    sample.push_back(rays[ray]);
  return sample;
}

std::vector<sim::Ray> structural_sample(const sim::Sphere& sphere, const Valid<Workload>& workload, std::size_t count) {
  const sim::LineField lines(sphere, sample_seed);
  if (workload.path_length == 0) return lines.lines(0, count);
  const glm::dvec3 half = 0.5 * glm::dvec3(workload.box[0], workload.box[1], workload.box[2]) + workload.disc_radius;
  std::vector<sim::Ray> sample = chords(lines, sphere, {sphere.centre - half, sphere.centre + half}, count);
  if (sample.empty()) return lines.lines(0, count);  // the box is too thin for any of them
  double sum = 0;
  for (const sim::Ray& ray : sample) sum += ray.length;
  const double share = std::min(1.0, workload.path_length * static_cast<double>(sample.size()) / sum);
  for (std::size_t i = 0; i < sample.size(); ++i) {
    sim::Ray& ray = sample[i];
    const double place = sim::uniform4(sample_seed, sim::Stream::structure, i)[0];
    ray.origin += place * (1 - share) * ray.length * ray.direction;
    ray.length *= share;
  }
  return sample;
}

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
  return {4, 1 << std::lround(power)};
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
