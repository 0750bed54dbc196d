#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "box_tree_pilot.hpp"

/// How far the counts of a pilot may be off because only some of the rays were culled.
namespace detp::sim::stream {

double BoxTreePilot::unseen(double precision) const {
  return independent_ ? 1 : std::max(0.0, 1 - precision * sampled_ / rays_);
}

/// The hits of the sampled rays. Where subtrees were drawn, as a ratio to what the discs' areas make likely:
///
///     h = Σ_certain h_s + R Σ_others e_s,   R = (Σ w h_s + κ) / (Σ w e_s + κ)
///
///   where  h_s, e_s  hits in a subtree; hits that its rays would have as lines at random (expected_hits_of_a_ray)
///          κ         two hits in the drawn subtrees: with few or none, R is near 1
///
/// Source     our derivation.
void BoxTreePilot::set_hits() {
  double hits = 0;
  double expected = 0;
  double others = 0;
  double weights = 0;
  double drawn = 0;
  for (Subtree& subtree : subtrees_) {
    subtree.expected_hits = known_[subtree.root].rays * expected_hits_of_a_ray(subtree.root);
    if (subtree.weight == 1) {
      hits_ += subtree.hits.sum;
      continue;
    }
    others += subtree.expected_hits;
    if (subtree.weight == 0) continue;
    hits += subtree.weight * subtree.hits.sum;
    expected += subtree.weight * subtree.expected_hits;
    weights += subtree.weight / known_[subtree.root].precision;
    drawn += 1;
  }
  if (drawn == 0) return;
  const double few = 2 * weights / drawn;
  hits_ratio_ = (hits + few) / (expected + few);
  hits_ += hits_ratio_ * others;
}

/// Errors of sums over the rays, and of what no sampled ray has met.
///
///     σ²/T² = [ 1.1/2 Σ_g (x_g - x_g+1)² / (Σ_g x_g)² + Σ_s w Σ_i (y_i - ȳ)² / (Σ_s w Σ_i y_i)² ] (1 - n/n_R)
///     ε     = √2 (1 - n/n_R)^½ n_R/n
///
///   where  T    a count of all rays
///          x_g  expected work (for hits: expected hits) of the sampled rays of group g in the subtrees that they cross. The
///               groups are 32 runs of consecutive rays, in a circle, so that rays of one photon are in one group. The
///               factor 1.1 makes two standard errors a limit of 95 %, though there are only so many groups.
///          y_i  the disc tests (for hits: hits) of sampled ray i in the smallest leaves of the drawn subtree s; w: the number of
///               subtrees for which it stands
///          ε    number of rays that may cross a node though no sampled ray does, or beyond those that the sampled rays stand
///               for: two sampled rays' worth, as a variance (plan_second_sample). Their work is that in the node
///               where it is largest.
///
/// Where a second sample was drawn, its rays count with their precision. Source: our derivation; for neighbouring groups
/// J. von Neumann (1941), "Distribution of the ratio of the mean square successive difference to the variance".
void BoxTreePilot::set_ray_errors() {
  std::array<double, groups> work{};
  std::array<double, groups> hits{};
  double all_work = 0;
  double all_hits = 0;
  for (const Subtree& subtree : subtrees_) {
    const double precision = known_[subtree.root].precision;
    const double share = std::sqrt(unseen(precision)) / precision;
    const double of_a_ray = work_of_a_ray(subtree.root);
    const double hits_of_a_ray = expected_hits_of_a_ray(subtree.root);
    double rays = 0;
    for (std::size_t g = 0; g < groups; ++g) {
      work[g] += share * of_a_ray * subtree.rays[g];
      hits[g] += share * hits_of_a_ray * subtree.rays[g];
      rays += subtree.rays[g] / precision;
    }
    all_work += of_a_ray * rays;
    all_hits += hits_of_a_ray * rays;
  }
  const auto between = [](const std::array<double, groups>& of_group, double all) {
    constexpr double few_groups = 1.1;
    double squares = 0;
    for (std::size_t g = 0; g < groups; ++g) squares += std::pow(of_group[g] - of_group[(g + 1) % groups], 2);
    return all > 0 ? 0.5 * few_groups * squares / (all * all) : 0;
  };
  const auto within = [&](SumOverRays Subtree::*count) {
    double sum = 0;
    double squares = 0;
    for (const Subtree& subtree : subtrees_) {
      sum += subtree.weight * (subtree.*count).sum;
      squares += subtree.weight * (subtree.*count).squares * unseen(known_[subtree.root].precision);
    }
    return sum > 0 ? squares / (sum * sum) : 0;
  };
  const double of_work = between(work, all_work);
  ray_errors_.tests = of_work + within(&Subtree::disc_tests);
  ray_errors_.hits = between(hits, all_hits) + within(&Subtree::hits);
  find_unseen();
}

/// Finds the node in which rays that no sampled ray stands for may do most work. Of a node that holds some with a sample of
/// their own, the rest counts.
void BoxTreePilot::find_unseen() {
  std::vector<double> work(work_);
  std::vector<double> discs(coarse_);
  double most = -1;
  const auto consider = [&](std::uint32_t node) {
    const double precision = known_[node].precision;
    const double rays = std::sqrt(2 * unseen(precision)) / precision * rays_ / sampled_;
    const double share = work_[node] > 0 ? work[node] / work_[node] : 1;
    const double of_rays = rays * work_of_a_ray(node) * share;
    if (!(of_rays > most)) return;
    most = of_rays;
    const double hits = expected_hits_of_a_ray(node) * discs[node] / nodes_[node].count;
    ray_errors_.node = node;
    ray_errors_.rays = rays;
    ray_errors_.work = of_rays;
    ray_errors_.unseen_hits = rays * hits;
  };
  for (const Subtree& subtree : subtrees_) {
    discs[subtree.root] = nodes_[subtree.root].count;
    consider(subtree.root);
  }
  for (std::uint32_t node = coarse_; node-- > 0;) {
    if (nodes_[node].count <= most_in_a_subtree) continue;
    work[node] = area_[node];
    for (const std::uint32_t child : {node + 1, nodes_[node].right})
      if (same_sample(child, node)) {
        work[node] += work[child];
        discs[node] += discs[child];
      }
    consider(node);
  }
}

/// Of a line through the box of the node's discs, at random: each disc is hit with the ratio of the areas.
double BoxTreePilot::expected_hits_of_a_ray(std::uint32_t node) const {
  const double discs = nodes_[node].count;
  const double area = std::numbers::pi * static_cast<double>(radius_) * radius_;
  return area_[node] > 0 ? std::min(discs, discs * area / area_[node]) : discs;
}

}  // namespace detp::sim::stream
