#include "technique.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "techniques.hpp"

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
double cull_slack(const Problem& problem, double farthest) {
  double largest = 0;
  for (const Disc& disc : problem.discs) largest = std::max(largest, disc.radius);
  double offset = 0;
  for (int axis = 0; axis < 3; ++axis) offset = std::max(offset, std::abs(problem.enclosing.centre[axis]));
  const double extent = farthest + problem.enclosing.radius;
  const double rounding = 2e-15 * extent;
  return 16e-12 * extent + std::cbrt(2 * largest * rounding * rounding) + 1e-15 * offset;
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

Problem make_problem(std::span<const Ray> rays, std::span<const Disc> discs, bool front_facing) {
  require_number("ray", rays.size());
  require_number("disc", discs.size());
  for (const Disc& disc : discs) check_disc(disc);
  Problem problem{rays, discs, enclosing_sphere(discs), front_facing};
  double farthest2 = 0;
  for (const Ray& ray : rays) {
    check_ray(ray);
    const glm::dvec3 away = ray.origin - problem.enclosing.centre;
    farthest2 = std::max(farthest2, glm::dot(away, away));
  }
  const double farthest = std::sqrt(farthest2);
  problem.slack = cull_slack(problem, farthest);
  if (!(farthest + problem.enclosing.radius < 1e100))
    throw std::invalid_argument("rays and discs must lie within 1e100 of each other, or their squares overflow");
  return problem;
}

void check_options(const RunOptions& options, const Problem& problem) {
  require_count("number of threads", options.threads, 0, 4096);
  if (options.totals != nullptr && !options.totals->empty() && options.totals->size() != problem.discs.size())
    throw std::invalid_argument(fmt::format("totals of {} discs cannot go on with {}; give those of the same discs",
                                            options.totals->size(), problem.discs.size()));
}

void finish(const Totals& totals, std::span<const Disc> discs, Outcome& outcome) {
  outcome.hits.resize(discs.size());
  outcome.irradiance.resize(discs.size());
  for (std::size_t disc = 0; disc < discs.size(); ++disc) {
    outcome.hits[disc] = totals[disc].hits;
    outcome.irradiance[disc] = irradiance(totals[disc], discs[disc]);
  }
}

Outcome run(const Problem& problem, const Candidate& candidate, const RunOptions& options) {
  check(candidate);
  check_options(options, problem);
  Outcome outcome;
  switch (candidate.technique) {
    case Technique::brute_force:
      run_brute_force(problem, options, outcome);
      break;
    case Technique::sphere_cache:
      run_sphere_cache(problem, std::get<SphereCacheParameters>(candidate.parameters), options, outcome);
      break;
    case Technique::sphere_cache_published:
      run_sphere_cache_published(problem, std::get<SphereCacheParameters>(candidate.parameters), options, outcome);
      break;
    case Technique::cell_spheres:
      run_cell_spheres(problem, std::get<CellSpheresParameters>(candidate.parameters), options, outcome);
      break;
    case Technique::sphere_tree:
      run_sphere_tree(problem, std::get<SphereTreeParameters>(candidate.parameters), options, outcome);
      break;
    case Technique::octree:
      run_octree(problem, std::get<OctreeParameters>(candidate.parameters), options, outcome);
      break;
    case Technique::grid:
      run_grid(problem, std::get<GridParameters>(candidate.parameters), options, outcome);
      break;
  }
  return outcome;
}

}  // namespace detp::sim
