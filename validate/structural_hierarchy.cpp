#include "structural_hierarchy.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "detp/model/line_measure.hpp"
#include "detp/sim/stop_check.hpp"
#include "detp/sim/technique/cell_walk.hpp"
#include "detp/sim/technique/ray_list.hpp"
#include "detp/sim/technique/sphere_tree.hpp"
#include "structural_boxes.hpp"

namespace detp::validate {
namespace {

/// P(sphere).
class Crossing {
 public:
  explicit Crossing(const sim::Sphere& enclosing) : enclosing_(enclosing) {}

  [[nodiscard]] double operator()(const sim::Sphere& sphere) const {
    const double ratio = sphere.radius / enclosing_.radius;
    const double between = glm::distance(sphere.centre, enclosing_.centre);
    // To 1e-9, for a sphere as large as S₀ is not poking out by rounding alone.
    if (between + sphere.radius <= enclosing_.radius * (1 + 1e-9)) return std::min(1.0, ratio * ratio);
    return ratio * ratio * model::both_hit_share(enclosing_.radius, sphere.radius, between);
  }

 private:
  sim::Sphere enclosing_;
};

/// Per ray.
Counts<double> cell_spheres(const sim::Problem& problem, const CellSpheresParameters& parameters,
                            const std::stop_token& stop) {
  sim::StopCheck check(stop, "counting spheres");
  const Crossing crossing(problem.enclosing);
  sim::CellWalk walk(problem.discs, parameters.depth);
  std::vector<double> listed(static_cast<std::size_t>(parameters.depth) + 1, 1);  // S₀'s list: every ray
  Counts<double> counts;
  for (const std::uint32_t d : sim::along_curve(problem.discs, SampleOrder::lebesgue, stop)) {
    for (int level = std::max(1, walk.enter(problem.discs[d])); level <= parameters.depth; ++level) {
      const auto i = static_cast<std::size_t>(level);
      listed[i] = crossing(walk.sphere(level));
      ++counts.rebuilds;
      counts.sphere_tests += listed[i - 1];
      counts.copies += listed[i];
    }
    counts.disc_tests += listed.back();
    check.after(listed.size());
  }
  return counts;
}

/// Σ P of the children's parents.
double parents(const std::vector<double>& crossed, std::size_t children, int in_a_parent) {
  double sum = 0;
  for (std::size_t child = 0; child < children; ++child) sum += crossed[child / static_cast<std::size_t>(in_a_parent)];
  return sum;
}

/// Per ray.
Counts<double> sphere_tree(const sim::Problem& problem, const SphereTreeParameters& parameters,
                           const std::stop_token& stop) {
  sim::StopCheck check(stop, "counting spheres");
  const Crossing crossing(problem.enclosing);
  const sim::SphereTree tree = sim::make_sphere_tree(
      problem.discs, sim::along_curve(problem.discs, SampleOrder::lebesgue, stop), parameters, stop);
  Counts<double> counts{.sphere_tests = 1, .rebuilds = static_cast<double>(tree.nodes())};
  for (std::size_t level = 0; level < tree.levels.size(); ++level) {
    std::vector<double> crossed;
    sim::for_each_checked(std::span(tree.levels[level]), check,
                          [&](const sim::Sphere& sphere) { crossed.push_back(crossing(sphere)); });
    counts.copies += std::accumulate(crossed.begin(), crossed.end(), 0.0);
    if (level == 0)
      counts.disc_tests = parents(crossed, problem.discs.size(), parameters.leaf);
    else
      counts.sphere_tests += parents(crossed, tree.levels[level - 1].size(), parameters.fan_out);
  }
  return counts;
}

/// Per ray, but for the nodes tested, which are all rays'.
Counts<double> box_tree(const sim::Problem& problem, double rays, const SphereTreeParameters& parameters,
                        const std::stop_token& stop) {
  const BoxTreeCounts counts = box_tree_counts(problem, rays, parameters, stop);
  return {.sphere_tests = counts.tests, .disc_tests = counts.discs, .copies = counts.listed, .rebuilds = counts.culls};
}

Counts<double> per_ray(const sim::Problem& problem, double rays, const Candidate& candidate,
                       const std::stop_token& stop) {
  if (candidate.technique == Technique::cell_spheres)
    return cell_spheres(problem, std::get<CellSpheresParameters>(candidate.parameters), stop);
  if (candidate.technique == Technique::sphere_tree) {
    const auto& parameters = std::get<SphereTreeParameters>(candidate.parameters);
    return parameters.bounds == Bounds::boxes ? box_tree(problem, rays, parameters, stop)
                                              : sphere_tree(problem, parameters, stop);
  }
  throw std::invalid_argument("only cell-spheres and sphere-tree are hierarchies of spheres");
}

}  // namespace

Counts<double> structural_hierarchy_counts(const sim::Problem& problem, double rays, const Candidate& candidate,
                                           const std::stop_token& stop) {
  check(candidate);
  require_count("number of rays", rays, 1, 1e18);
  Counts<double> counts = per_ray(problem, rays, candidate, stop);
  counts.sphere_tests *= rays;
  counts.copies *= rays;
  counts.disc_tests *= rays;
  counts.sorted = static_cast<double>(problem.discs.size());
  return counts;
}

}  // namespace detp::validate
