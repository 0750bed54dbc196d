#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/sim/threads.hpp"
#include "technique.hpp"

namespace detp::sim {
namespace {

void require_finite_vector(const char* what, const glm::dvec3& vector) {
  for (int axis = 0; axis < 3; ++axis) require_finite(what, vector[axis]);
}

void require_unit(const char* what, const glm::dvec3& vector) {
  require_finite_vector(what, vector);
  const double length = glm::length(vector);
  if (!(std::abs(length - 1) <= 1e-12))
    throw std::invalid_argument(fmt::format("{} must have length 1 (got {})", what, length));
}

/// Whether their squares alone show that the vector is finite, or 1 long (to 1e-12, with room for rounding).
bool surely_finite(const glm::dvec3& vector) { return glm::dot(vector, vector) < unbounded; }
bool surely_unit(const glm::dvec3& vector) { return std::abs(glm::dot(vector, vector) - 1) <= 1.99e-12; }

/// Of a million rays one by one, only those that a quick look leaves in doubt are checked part by part.
bool surely_sound(const Ray& ray) {
  return surely_finite(ray.origin) && surely_unit(ray.direction) && ray.length > 0 && ray.power >= 0 &&
         ray.power < unbounded;
}

bool surely_sound(const Disc& disc) {
  return surely_finite(disc.centre) && surely_unit(disc.normal) && disc.radius >= 1e-100 && disc.radius < unbounded;
}

void check_ray(const Ray& ray) {
  if (surely_sound(ray)) return;
  require_finite_vector("origin of a ray", ray.origin);
  require_unit("direction of a ray", ray.direction);
  if (!ray.is_line()) require_positive("length of a ray", ray.length);
  require_non_negative("power of a ray", ray.power);
}

void check_disc(const Disc& disc) {
  if (surely_sound(disc)) return;
  require_finite_vector("centre of a disc", disc.centre);
  require_unit("normal of a disc", disc.normal);
  require_positive("disc radius", disc.radius);
  if (disc.radius < 1e-100)
    throw std::invalid_argument("disc radius must be at least 1e-100, or its square underflows");
}

void require_number(const char* what, std::size_t count) {
  if (count == 0) throw std::invalid_argument(fmt::format("there must be at least one {}", what));
  if (count >= UINT32_MAX)
    throw std::length_error(fmt::format("{} {}s are too many; the most is 4294967294", count, what));
}

/// What make_problem promises. sim/README.md proves it enough for every cull.
double cull_slack(const Problem& problem) {
  double largest = 0;
  for (const Disc& disc : problem.discs) largest = std::max(largest, disc.radius);
  double offset = 0;
  for (int axis = 0; axis < 3; ++axis) offset = std::max(offset, std::abs(problem.enclosing.centre[axis]));
  const double extent = problem.farthest + problem.enclosing.radius;
  const double rounding = 2e-15 * extent;
  return 16e-12 * extent + std::cbrt(2 * largest * rounding * rounding) + 1e-15 * offset;
}

void set_farthest(Problem& problem, double farthest) {
  if (!(farthest + problem.enclosing.radius < 1e100))
    throw std::invalid_argument("rays and discs must lie within 1e100 of each other, or their squares overflow");
  problem.farthest = farthest;
  problem.slack = cull_slack(problem);
}

/// What a look at some rays shows.
struct Glance {
  double farthest2 = 0;  ///< square of the distance of the farthest origin
  bool sound = true;
};

/// The distance of the farthest origin from the centre. Of several rays that are unsound, the first is complained of.
double check_rays(std::span<const Ray> rays, const glm::dvec3& centre) {
  using Range = tbb::blocked_range<std::size_t>;
  const Glance seen = tbb::parallel_reduce(
      Range(0, rays.size(), std::size_t{1} << 14), Glance{},
      [&](const Range& range, Glance glance) {
        for (const Ray& ray : rays.subspan(range.begin(), range.size())) {
          glance.sound = glance.sound && surely_sound(ray);
          const glm::dvec3 away = ray.origin - centre;
          glance.farthest2 = std::max(glance.farthest2, glm::dot(away, away));
        }
        return glance;
      },
      [](const Glance& a, const Glance& b) {
        return Glance{std::max(a.farthest2, b.farthest2), a.sound && b.sound};
      });
  if (!seen.sound) std::for_each(rays.begin(), rays.end(), check_ray);
  return std::sqrt(seen.farthest2);
}

}  // namespace

Sphere enclosing_sphere(std::span<const Disc> discs) {
  Box box;
  double largest = 0;
  for (const Disc& disc : discs) {
    box.include(disc.centre);
    largest = std::max(largest, disc.radius);
  }
  const glm::dvec3 centre = box.centre();
  // To the farther corner, as computed: half the diagonal can be an ulp short of it.
  const double reach = std::max(glm::distance(centre, box.low), glm::distance(centre, box.high));
  return {centre, (reach + largest) * (1 + 1e-15)};
}

Problem make_problem(std::span<const Ray> rays, std::span<const Disc> discs, bool front_facing, int threads) {
  require_number("ray", rays.size());
  require_number("disc", discs.size());
  for (const Disc& disc : discs) check_disc(disc);
  Problem problem{rays, discs, enclosing_sphere(discs), front_facing};
  double farthest = 0;
  on_threads(thread_count(threads), [&] { farthest = check_rays(rays, problem.enclosing.centre); });
  set_farthest(problem, farthest);
  return problem;
}

Problem make_problem_without_rays(std::span<const Disc> discs, double farthest, bool front_facing) {
  require_number("disc", discs.size());
  for (const Disc& disc : discs) check_disc(disc);
  require_non_negative("distance of the farthest ray's origin", farthest);
  Problem problem{{}, discs, enclosing_sphere(discs), front_facing};
  set_farthest(problem, farthest);
  return problem;
}

void set_rays(Problem& problem, std::span<const Ray> rays, int threads) {
  require_number("ray", rays.size());
  double farthest = 0;
  on_threads(thread_count(threads), [&] { farthest = check_rays(rays, problem.enclosing.centre); });
  if (farthest > problem.farthest)
    throw std::invalid_argument(
        fmt::format("a ray starts {} from the centre of the discs, but none was to start farther away than {}",
                    farthest, problem.farthest));
  problem.rays = rays;
}

}  // namespace detp::sim
