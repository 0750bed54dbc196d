#include "structural_walk.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "detp/model/line_measure.hpp"
#include "detp/sim/lebesgue.hpp"

namespace detp::validate {
namespace {

constexpr std::size_t ancestors = 6;

/// both_hit_share(1, ratio, offset), tabulated over the offset up to 1: a sphere is centred inside those around it.
class HitShare {
 public:
  explicit HitShare(double ratio) {
    for (std::size_t i = 0; i < shares_.size(); ++i)
      shares_[i] = model::both_hit_share(1, ratio, static_cast<double>(i) / steps);
  }

  [[nodiscard]] double operator()(double offset) const {
    const double place = std::min(offset, 1.0) * steps;
    const auto i = std::min(static_cast<std::size_t>(place), shares_.size() - 2);
    const double weight = place - static_cast<double>(i);
    return (1 - weight) * shares_[i] + weight * shares_[i + 1];
  }

 private:
  static constexpr int steps = 256;
  std::array<double, steps + 1> shares_{};
};

struct Level {
  sim::Sphere sphere;
  double listed = 1;  ///< expected, per ray of S₀
};

class Walk {
 public:
  Walk(const sim::Sphere& enclosing, const SphereCacheParameters& parameters, double disc_radius) {
    levels_.push_back({enclosing, 1});
    for (std::int64_t i = 1; i <= parameters.spheres; ++i) {
      const double radius = enclosing.radius * std::pow(parameters.ratio, static_cast<double>(i));
      if (radius < disc_radius) break;
      levels_.push_back({{enclosing.centre, radius}, 0});
    }
    for (std::size_t i = 1; i <= ancestors; ++i)
      shares_.emplace_back(std::pow(parameters.ratio, static_cast<double>(i)));
    expected_.spheres.resize(levels_.size() - 1);
  }

  void visit(const sim::Disc& disc) {
    std::size_t i = 1;
    while (i < valid_ && glm::distance(disc.centre, levels_[i].sphere.centre) + disc.radius <= levels_[i].sphere.radius)
      ++i;
    for (; i < levels_.size(); ++i) rebuild(i, disc.centre);
    valid_ = levels_.size();
    expected_.disc_tests += levels_.back().listed;
  }

  [[nodiscard]] ExpectedWalk finish() && {
    for (const ExpectedSphere& sphere : expected_.spheres) expected_.sphere_tests += sphere.tests;
    return std::move(expected_);
  }

 private:
  void rebuild(std::size_t i, const glm::dvec3& centre) {
    levels_[i].sphere.centre = centre;
    expected_.spheres[i - 1].rebuilds += 1;
    expected_.spheres[i - 1].tests += levels_[i - 1].listed;
    double product = 1;
    double least = 1;
    for (std::size_t out = 1; out < i && out <= ancestors; ++out) {
      const sim::Sphere& around = levels_[i - out].sphere;
      const double share = shares_[out - 1](glm::distance(centre, around.centre) / around.radius);
      product *= share;
      least = std::min(least, share);
    }
    const double ratio = levels_[i].sphere.radius / levels_[0].sphere.radius;
    levels_[i].listed = std::min(levels_[i - 1].listed, ratio * ratio * std::sqrt(product * least));
  }

  std::vector<Level> levels_;
  std::vector<HitShare> shares_;
  std::size_t valid_ = 1;
  ExpectedWalk expected_;
};

}  // namespace

ExpectedWalk structural_walk(std::span<const sim::Disc> discs, const sim::Sphere& enclosing,
                             const SphereCacheParameters& parameters) {
  double smallest = enclosing.radius;
  std::vector<glm::dvec3> centres;
  for (const sim::Disc& disc : discs) {
    smallest = std::min(smallest, disc.radius);
    centres.push_back(disc.centre);
  }
  Walk walk(enclosing, parameters, smallest);
  for (const std::uint32_t i : sim::lebesgue_order(centres)) walk.visit(discs[i]);
  return std::move(walk).finish();
}

}  // namespace detp::validate
