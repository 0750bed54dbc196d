#include "sphere_walk.hpp"

#include <algorithm>
#include <cmath>

namespace detp::sim {
namespace {

bool holds(const Sphere& sphere, const Disc& disc) {
  return glm::distance(disc.centre, sphere.centre) + disc.radius <= sphere.radius;
}

}  // namespace

SphereWalk::SphereWalk(const Problem& problem, const SphereCacheParameters& parameters, Serving serving)
    : serving_(serving), spheres_{problem.enclosing} {
  double smallest = problem.enclosing.radius;
  for (const Disc& disc : problem.discs) smallest = std::min(smallest, disc.radius);
  for (std::int64_t i = 1; i <= parameters.spheres; ++i) {
    const double radius = problem.enclosing.radius * std::pow(parameters.ratio, static_cast<double>(i));
    if (!(radius >= smallest)) break;
    spheres_.push_back({{}, radius});
  }
}

int SphereWalk::serving(const Disc& disc) const {
  int level = 0;
  if (serving_ == Serving::all_that_hold) {
    while (level + 1 < built_ && holds(sphere(level + 1), disc)) ++level;
  } else {
    level = built_ - 1;
    while (level > 0 && !holds(sphere(level), disc)) --level;
  }
  return level;
}

int SphereWalk::enter(const Disc& disc) {
  const int first = serving(disc) + 1;
  built_ = first;
  while (built_ <= deepest() && disc.radius <= sphere(built_).radius)
    spheres_[static_cast<std::size_t>(built_++)].centre = disc.centre;
  return first;
}

}  // namespace detp::sim
