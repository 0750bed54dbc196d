#include "structural_sample.hpp"

#include <algorithm>
#include <cmath>

#include "detp/sim/geometry/random.hpp"
#include "detp/sim/geometry/ray_box.hpp"
#include "detp/sim/rays/line_field.hpp"

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

}  // namespace

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

}  // namespace detp::validate
