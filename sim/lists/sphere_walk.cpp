#include "sphere_walk.hpp"

#include <algorithm>
#include <cmath>

#include "detp/sim/base/memory.hpp"

namespace detp::sim {
namespace {

bool holds(const Sphere& sphere, const Disc& disc) {
  return glm::distance(disc.centre, sphere.centre) + disc.radius <= sphere.radius;
}

double smallest_radius(std::span<const Disc> discs) {
  double smallest = unbounded;
  for (const Disc& disc : discs) smallest = std::min(smallest, disc.radius);
  return smallest;
}

}  // namespace

double SphereWalk::levels(const Problem& problem, const SphereCacheParameters& parameters) {
  const double steps =
      std::log(smallest_radius(problem.discs()) / problem.enclosing().radius) / std::log(parameters.ratio);
  return std::min(static_cast<double>(parameters.spheres), std::floor(steps) + 1);  // one more, for rounding
}

SphereWalk::SphereWalk(const Problem& problem, const SphereCacheParameters& parameters, ServingSpheres serving)
    : serving_(serving) {
  const double smallest = smallest_radius(problem.discs());
  require_memory("the spheres", levels(problem, parameters) * sizeof(Sphere));
  spheres_.reserve(static_cast<std::size_t>(levels(problem, parameters)) + 1);
  spheres_.push_back(problem.enclosing());
  for (std::int64_t i = 1; i <= parameters.spheres; ++i) {
    const double radius = problem.enclosing().radius * std::pow(parameters.ratio, static_cast<double>(i));
    if (!(radius >= smallest)) break;
    spheres_.push_back({{}, radius});
  }
}

int SphereWalk::serving_level(const Disc& disc) const {
  int level = 0;
  if (serving_ == ServingSpheres::all_that_hold) {
    while (level + 1 < built_ && holds(sphere(level + 1), disc)) ++level;
  } else {
    level = built_ - 1;
    while (level > 0 && !holds(sphere(level), disc)) --level;
  }
  return level;
}

int SphereWalk::enter(const Disc& disc) {
  const int first = serving_level(disc) + 1;
  built_ = first;
  while (built_ <= deepest() && disc.radius <= sphere(built_).radius)
    spheres_[static_cast<std::size_t>(built_++)].centre = disc.centre;
  return first;
}

}  // namespace detp::sim
