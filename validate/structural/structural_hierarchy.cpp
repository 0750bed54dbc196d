#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "detp/model/lines/line_measure.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/lists/cell_walk.hpp"
#include "detp/sim/lists/plain/ray_list.hpp"
#include "detp/sim/lists/sphere_nodes.hpp"
#include "structural_parts.hpp"

/// Expected counts of hierarchies of spheres and of boxes, computed from the hierarchy without rays.
///
/// Counts of cell-spheres, sphere-tree and box-tree on isotropic lines through S₀:
///
///     cull_tests = n_R Σ P(parent)        listed = n_R Σ P(sphere)
///     disc_tests = n_R Σ_discs P(innermost sphere)
///     P(sphere) = (r/r₀)² × share of the lines through the sphere that also cross S₀
///
/// The sums are over all spheres of the hierarchy, each built once. Each sphere lies in its parent sphere, so its list
/// holds exactly the rays that cross both the sphere and S₀. The share is 1 for a sphere inside S₀, else
/// both_hit_share. Hits are left at 0. For a box tree (structural_parts.hpp) the same sums are over boxes, except that
/// the root is not tested. In a tree, `culls` is the expected number of nodes that get a list: nodes whose parent's
/// list holds a ray. With cell-spheres, every sphere gets a list.
///
/// Source     our derivation.
/// Valid      lines of the measure μ_ℓ through S₀; discs of any radii.
/// Accuracy   exact, except for sphere-tree if a sphere extends outside S₀. Boxes, fan-out 4, leaf 16: @uniform, @tree,
///            @courtyard, @cornell, 2000 and 50 000 samples, d 0.25, 1 and 4 % of the scene's side, 400 000 lines.
///            Median and largest deviation of expected from observed counts, which include the noise of the lines (0.44
///            and 2.3 % of hits): tests of boxes 0.25, 0.71 %; rays listed 0.29, 0.84 %; tests of discs 0.31, 1.1 %;
///            nodes tested 0.00, 0.81 %.
/// Throws     std::invalid_argument for another technique, or parameters out of range; sim::Stopped if a stop was
///            requested.
namespace detp::validate {
namespace {

/// Evaluates P(sphere).
class Crossing {
 public:
  explicit Crossing(const sim::Sphere& enclosing) : enclosing_(enclosing) {}

  [[nodiscard]] double operator()(const sim::Sphere& sphere) const {
    const double ratio = sphere.radius / enclosing_.radius;
    const double between = glm::distance(sphere.centre, enclosing_.centre);
    // The tolerance 1e-9 allows for rounding, so that S₀ itself counts as inside S₀.
    if (between + sphere.radius <= enclosing_.radius * (1 + 1e-9)) return std::min(1.0, ratio * ratio);
    return ratio * ratio * model::both_hit_share(enclosing_.radius, sphere.radius, between);
  }

 private:
  sim::Sphere enclosing_;
};

/// The probability that a list holds at least one of `rays` rays, if each ray is in the list with probability `share`.
double holds_a_ray(double share, double rays) { return share < 1 ? -std::expm1(rays * std::log1p(-share)) : 1; }

/// Sums over the children of all nodes of one level.
struct OverChildren {
  double share = 0;    ///< Σ P(parent)
  double reached = 0;  ///< Σ probability that the parent's list holds a ray
};

OverChildren over_children(const std::vector<double>& crossed, std::size_t children, int in_a_parent, double rays) {
  OverChildren sums;
  for (std::size_t child = 0; child < children; ++child) {
    const double share = crossed[child / static_cast<std::size_t>(in_a_parent)];
    sums.share += share;
    sums.reached += holds_a_ray(share, rays);
  }
  return sums;
}

/// Tests and listed rays are those of each ray; the other counts are of all.
Counts<double> of_rays(Counts<double> per_ray, const sim::Problem& problem, double rays) {
  per_ray.cull_tests *= rays;
  per_ray.listed *= rays;
  per_ray.disc_tests *= rays;
  per_ray.sorted = static_cast<double>(problem.discs().size());
  return per_ray;
}

}  // namespace

Counts<double> counts_of(const sim::Problem& problem, const Lines& lines, const CellSpheresParameters& parameters,
                         const std::stop_token& stop) {
  sim::StopCheck check(stop, "counting spheres");
  const Crossing crossing(problem.enclosing());
  sim::CellWalk walk(problem.discs(), parameters.depth);
  std::vector<double> listed(static_cast<std::size_t>(parameters.depth) + 1, 1);  // S₀'s list: every ray
  Counts<double> counts;
  for (const std::uint32_t d : sim::along_curve(problem.discs(), SampleOrder::lebesgue, stop)) {
    for (int level = std::max(1, walk.enter(problem.discs()[d])); level <= parameters.depth; ++level) {
      const auto i = static_cast<std::size_t>(level);
      listed[i] = crossing(walk.sphere(level));
      ++counts.culls;
      counts.cull_tests += listed[i - 1];
      counts.listed += listed[i];
    }
    ++counts.visits;
    counts.disc_tests += listed.back();
    check.after(listed.size());
  }
  const double blocks = lines.blocks(problem).count();
  counts.culls *= blocks;
  counts.visits *= blocks;
  return of_rays(counts, problem, lines.rays);
}

Counts<double> counts_of(const sim::Problem& problem, const Lines& lines, const SphereTreeParameters& parameters,
                         const std::stop_token& stop) {
  sim::StopCheck check(stop, "counting spheres");
  const Crossing crossing(problem.enclosing());
  const sim::SphereTree tree = sim::make_sphere_tree(
      problem.discs(), sim::along_curve(problem.discs(), SampleOrder::lebesgue, stop), parameters, stop);
  Counts<double> counts{.cull_tests = 1, .culls = 1, .made = static_cast<double>(tree.nodes())};
  for (std::size_t level = 0; level < tree.levels.size(); ++level) {
    std::vector<double> crossed;
    sim::for_each_checked(std::span(tree.levels[level]), check,
                          [&](const sim::Sphere& sphere) { crossed.push_back(crossing(sphere)); });
    counts.listed += std::accumulate(crossed.begin(), crossed.end(), 0.0);
    const bool leaves = level == 0;
    const std::size_t children = leaves ? problem.discs().size() : tree.levels[level - 1].size();
    const OverChildren sums =
        over_children(crossed, children, leaves ? parameters.leaf : parameters.fan_out, lines.rays);
    (leaves ? counts.disc_tests : counts.cull_tests) += sums.share;
    (leaves ? counts.visits : counts.culls) += sums.reached;
  }
  return of_rays(counts, problem, lines.rays);
}

}  // namespace detp::validate
