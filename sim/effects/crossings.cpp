#include "crossings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/random.hpp"

namespace detp::sim {
namespace {

constexpr std::size_t most_spheres = 512;
constexpr std::size_t most_tested = 512;  // rays
constexpr double crossed_by = 0.01;       // share of uniform rays that cross a sphere

/// The centres of some discs, relative to the centre of S₀ and in units of the spheres' radius. In floats, so that the
/// compiler tests several at once: a sphere that a ray just touches may be decided either way.
class Centres {
 public:
  Centres(const Problem& problem, const std::vector<std::size_t>& discs, double radius)
      : centre_(problem.enclosing().centre), radius_(radius), squares_(discs.size()) {
    for (int axis = 0; axis < 3; ++axis)
      for (const std::size_t disc : discs)
        along_[axis].push_back(static_cast<float>((problem.discs()[disc].centre[axis] - centre_[axis]) / radius_));
  }

  /// Squared distances of the centres from the ray.
  const std::vector<float>& squared_distances(const Ray& ray) {
    const glm::vec3 origin((ray.origin - centre_) / radius_);
    const glm::vec3 heading(ray.direction);
    const auto length = static_cast<float>(ray.length / radius_);
    const float from = ray.is_line() ? -length : 0;
    for (std::size_t j = 0; j < squares_.size(); ++j) {
      const float x = along_[0][j] - origin.x;
      const float y = along_[1][j] - origin.y;
      const float z = along_[2][j] - origin.z;
      const float place = x * heading.x + y * heading.y + z * heading.z;
      const float nearest = std::min(std::max(place, from), length);
      const float a = x - nearest * heading.x;
      const float b = y - nearest * heading.y;
      const float c = z - nearest * heading.z;
      squares_[j] = a * a + b * b + c * c;
    }
    return squares_;
  }

 private:
  glm::dvec3 centre_;
  double radius_;
  std::array<std::vector<float>, 3> along_;
  std::vector<float> squares_;
};

/// Whether the ray crosses the disc enlarged to the radius.
bool crosses(const Ray& ray, const Disc& disc, double radius, bool front_facing) {
  const double slope = glm::dot(ray.direction, disc.normal);
  if (slope == 0 || (front_facing && slope > 0)) return false;
  const glm::dvec3 to = disc.centre - ray.origin;
  const double at = glm::dot(to, disc.normal) / slope;
  if (!(at >= (ray.is_line() ? -unbounded : 0) && at <= ray.length)) return false;
  const glm::dvec3 off = at * ray.direction - to;
  return glm::dot(off, off) <= radius * radius;
}

Crossings counted(const Problem& problem, double radius, const std::stop_token& stop) {
  StopCheck check(stop, "looking for uneven rays");
  const auto rays = stratified_sample(problem.rays().size(), most_tested, 2, Stream::evidence);
  const auto discs = stratified_sample(problem.discs().size(), most_spheres, 2, Stream::evidence);
  Centres centres(problem, discs, radius);
  std::vector<double> of_disc(discs.size());
  std::vector<double> of_ray(rays.size());
  double in_disc = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    check.after(discs.size());
    const Ray& ray = problem.rays()[rays[i]];
    const std::vector<float>& squares = centres.squared_distances(ray);
    for (std::size_t j = 0; j < discs.size(); ++j) {
      if (!(squares[j] <= 1)) continue;
      of_ray[i] += 1;
      of_disc[j] += 1;
      if (crosses(ray, problem.discs()[discs[j]], radius, problem.front_facing())) in_disc += 1;
    }
  }
  const double pairs = static_cast<double>(rays.size()) * static_cast<double>(discs.size());
  double sum = 0;
  for (const double one : of_ray) sum += one;
  const auto relative_variance = [sum](const std::vector<double>& counts) {
    const double mean = sum / static_cast<double>(counts.size());
    double variance = 0;
    for (const double one : counts) variance += (one - mean) * (one - mean);
    return variance / (mean * mean) / static_cast<double>(counts.size()) / static_cast<double>(counts.size());
  };
  if (!(sum > 0)) return {.radius = radius};
  const double hits = std::max(1.0, in_disc);
  return {.radius = radius,
          .spheres = sum / pairs,
          .discs = in_disc / pairs,
          .spheres_error = std::sqrt(relative_variance(of_ray) + relative_variance(of_disc)),
          .ratio_error = std::sqrt(std::max(0.0, 1 / hits - 1 / sum))};
}

}  // namespace

UniformRays uniform_rays(const Workload& workload) {
  const double d = workload.disc_radius;
  double space = 1;
  for (const double side : workload.box) space *= side + 2 * d;
  return {workload.sphere_radius, workload.path_length, space};
}

Crossings count_crossings(const Problem& problem, const UniformRays& uniform, const std::stop_token& stop) {
  return counted(problem, uniform.radius_for(crossed_by), stop);
}

}  // namespace detp::sim
