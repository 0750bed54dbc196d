#include "structural_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/curve.hpp"
#include "detp/sim/rays/line_field.hpp"

namespace detp::validate {
namespace {

constexpr std::size_t ancestors = 32;
constexpr std::size_t line_pool_size = 32768;
constexpr std::uint64_t line_pool_seed = 1;

/// Isotropic lines through the unit sphere, used to integrate. Made once, because drawing them takes longer than a walk
/// along few samples.
const std::vector<sim::Ray>& line_pool() {
  static const std::vector<sim::Ray> pool = sim::LineField({}, line_pool_seed).lines(0, line_pool_size);
  return pool;
}

bool crosses(const glm::dvec3& point, const glm::dvec3& direction, const sim::Sphere& sphere) {
  const glm::dvec3 w = point - sphere.centre;
  const double along = glm::dot(w, direction);
  return glm::dot(w, w) - along * along <= sphere.radius * sphere.radius;
}

struct Level {
  sim::Sphere sphere;
  double listed = 1;  ///< expected share of all rays that are in the sphere's list
};

class Walk {
 public:
  Walk(const sim::Sphere& enclosing, const SphereCacheParameters& parameters, double disc_radius,
       const std::stop_token& stop)
      : check_(stop, "walking the spheres") {
    levels_.push_back({enclosing, 1});
    for (std::int64_t i = 1; i <= parameters.spheres; ++i) {
      const double radius = enclosing.radius * std::pow(parameters.ratio, static_cast<double>(i));
      if (radius < disc_radius) break;
      levels_.push_back({{enclosing.centre, radius}, 0});
    }
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
    for (const ExpectedSphere& sphere : expected_.spheres) expected_.cull_tests += sphere.tests;
    return std::move(expected_);
  }

 private:
  void rebuild(std::size_t i, const glm::dvec3& centre) {
    levels_[i].sphere.centre = centre;
    ExpectedSphere& expected = expected_.spheres[i - 1];
    expected.rebuilds += 1;
    expected.tests += levels_[i - 1].listed;
    // The first 500 rebuilds use more lines each. If there are many more rebuilds, the errors average out.
    const std::size_t lines = expected.rebuilds < 500 ? 64 : 8;
    const double ratio = levels_[i].sphere.radius / levels_[0].sphere.radius;
    levels_[i].listed = ratio * ratio * share_listed(i, lines);
    expected.listed += levels_[i].listed;
  }

  /// Share of the lines through S_i that also cross the spheres around S_i. S₀ is one of them, since S_i may extend
  /// outside S₀. Uses the next lines of the pool, moved so that they go through S_i.
  double share_listed(std::size_t i, std::size_t lines) {
    const sim::Sphere& sphere = levels_[i].sphere;
    const std::size_t outermost = i > ancestors ? i - ancestors : 0;
    std::size_t listed = 0;
    for (std::size_t n = 0; n < lines; ++n) {
      const sim::Ray& line = pool_[next_++ % line_pool_size];
      const glm::dvec3 point = sphere.centre + sphere.radius * line.origin;
      std::size_t around = i;  // the line crosses all tested spheres, around … i - 1
      while (around > outermost && crosses(point, line.direction, levels_[around - 1].sphere)) --around;
      listed += around == outermost ? 1 : 0;
      check_.after(i - around + 1);
    }
    return static_cast<double>(listed) / static_cast<double>(lines);
  }

  sim::StopCheck check_;
  std::vector<Level> levels_;
  const std::vector<sim::Ray>& pool_ = line_pool();
  std::size_t next_ = 0;
  std::size_t valid_ = 1;
  ExpectedWalk expected_;
};

}  // namespace

ExpectedWalk structural_walk(std::span<const sim::Disc> discs, const sim::Sphere& enclosing,
                             const SphereCacheParameters& parameters, const std::stop_token& stop) {
  double smallest = enclosing.radius;
  std::vector<glm::dvec3> centres;
  for (const sim::Disc& disc : discs) {
    smallest = std::min(smallest, disc.radius);
    centres.push_back(disc.centre);
  }
  Walk walk(enclosing, parameters, smallest, stop);
  for (const std::uint32_t i : sim::lebesgue_order(centres, stop)) walk.visit(discs[i]);
  return std::move(walk).finish();
}

Counts<double> counts_of(const sim::Problem& problem, const Lines& lines, const SphereCacheParameters& parameters,
                         const std::stop_token& stop) {
  if (parameters.order != SampleOrder::lebesgue)
    throw std::invalid_argument(
        fmt::format("the sphere cache has structural counts along the Morton (lebesgue) curve only (got order {})",
                    name(parameters.order)));
  const ExpectedWalk walk = structural_walk(problem.discs(), problem.enclosing(), parameters, stop);
  const auto discs = static_cast<double>(problem.discs().size());
  const double blocks = lines.blocks(problem).count();
  Counts<double> counts{.cull_tests = lines.rays * walk.cull_tests,
                        .visits = blocks * discs,
                        .disc_tests = lines.rays * walk.disc_tests,
                        .sorted = discs};
  for (const ExpectedSphere& sphere : walk.spheres) {
    counts.culls += blocks * sphere.rebuilds;
    counts.listed += lines.rays * sphere.listed;
  }
  return counts;
}

}  // namespace detp::validate
