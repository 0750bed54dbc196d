#include "effect.hpp"

#include <cmath>

#include "detp/sim/geometry/random.hpp"

namespace detp::sim {

namespace {

/// Rough, of a box tree on one thread.
double search_seconds(double rays, double discs) { return 60e-9 * discs + 150e-9 * rays; }

}  // namespace

bool evidence_can_pay(double rays, double discs) {
  constexpr double least_seconds = 0.03;
  return search_seconds(rays, discs) >= least_seconds;
}

EvidenceEffort EvidenceEffort::for_search(double rays, double discs) {
  constexpr double seconds_of_all = 1e-3;
  constexpr double least_seconds = 0.2e-3;
  const double share = std::min(1.0, std::max(least_seconds, 0.005 * search_seconds(rays, discs)) / seconds_of_all);
  const auto part = [share](std::size_t all) { return static_cast<std::size_t>(share * static_cast<double>(all)); };
  const EvidenceEffort all;
  return {part(all.discs), part(all.rays), part(all.crossing_rays)};
}

const std::vector<std::size_t>& EffectSample::rays() const {
  return once(rays_, [&] { return stratified_sample(problem.rays().size(), effort.rays, 1, Stream::evidence); });
}

const CurveSample& EffectSample::discs() const {
  return once(discs_, [&] { return curve_sample(problem.discs(), problem.enclosing(), effort.discs, stop); });
}

const SampleDimension& EffectSample::dimension() const {
  return once(dimension_, [&] { return sample_dimension(discs().keys); });
}

const std::vector<SampledNode>& EffectSample::tree() const {
  return once(tree_, [&] { return sampled_tree(discs()); });
}

const PathsInside& EffectSample::paths() const {
  return once(paths_, [&] {
    if (!problem.segments()) return PathsInside{};
    return paths_inside(problem, rays(), problem.centres(), problem.radii().rms, stop);
  });
}

const UniformRays& EffectSample::uniform() const {
  return once(uniform_, [&] {
    const glm::dvec3 size = problem.centres().size();
    return uniform_rays({.disc_radius = problem.radii().rms,
                         .sphere_radius = problem.enclosing().radius,
                         .box = {size.x, size.y, size.z},
                         .path_length = paths().length});
  });
}

const Crossings& EffectSample::crossings() const {
  return once(crossings_, [&] { return count_crossings(*this); });
}

bool Threshold::passed(double value) const {
  switch (side) {
    case Side::above:
      return value > at;
    case Side::below:
      return value < at;
    case Side::apart:
      break;
  }
  return std::abs(value - at) > tolerance;
}

double Threshold::distance(double value) const { return std::abs(std::abs(value - at) - tolerance); }

double Threshold::over(double value) const {
  switch (side) {
    case Side::above:
      return at > 0 && value > 0 ? value / at : 0;
    case Side::below:
      return value > 0 ? at / value : 0;
    case Side::apart:
      break;
  }
  return std::abs(value - at) / tolerance;
}

}  // namespace detp::sim
