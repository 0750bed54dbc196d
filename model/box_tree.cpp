#include "box_tree.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "line_measure.hpp"

namespace detp::model {
namespace {

/// What is tabulated, as logarithms, of all nodes but the root; sums weighted by the children, by 1, by the discs.
enum Term : std::size_t { nodes, inner_area, area, leaf_area, inner_volume, volume, leaf_volume, terms };

constexpr int most_halvings = 20;           // n_P = two leaves … 2²⁰
constexpr std::size_t distance_steps = 11;  // d = 2⁻⁴ … 2⁶ sample distances

constexpr std::size_t steps_of(int leaf) {
  return static_cast<std::size_t>(most_halvings - std::countr_zero(static_cast<unsigned>(leaf)));
}

/// Steps of n_P in the tables of all leaves before this one; of no leaf, in all.
constexpr std::size_t steps_before(int leaf) {
  std::size_t steps = 0;
  for (const int other : box_tree_leaves) {
    if (other == leaf) break;
    steps += steps_of(other);
  }
  return steps;
}

constexpr std::size_t sample_steps = steps_before(0);

#include "box_tree_table.inc"

/// An entry below the first one or beyond the last, and the weight of the one after it; may go on beyond the last.
struct Place {
  std::size_t low;
  double weight;
};

Place place_of(double at, std::size_t entries, bool goes_on) {
  const auto last = static_cast<double>(entries - 1);
  const double low = std::clamp(std::floor(at), 0.0, last - 1);
  return {static_cast<std::size_t>(low), std::clamp(at - low, 0.0, goes_on ? 1e3 : 1.0)};
}

/// The sums of one tree, over a² and a³.
class Sums {
 public:
  Sums(int leaf, double samples, double radius_over_distance, double dimension)
      : first_(2 * terms * steps_before(leaf)),
        sample_steps_(steps_of(leaf)),
        sample_(place_of(std::log2(samples / (2 * leaf)), sample_steps_, true)),
        distance_(place_of(std::log2(radius_over_distance) + 4, distance_steps, false)),
        volume_weight_(dimension - 2) {}

  [[nodiscard]] double operator[](Term term) const {
    return std::exp2(mixed(volume_weight_, of_dimension(0, term), of_dimension(1, term)));
  }

 private:
  static double mixed(double weight, double a, double b) { return (1 - weight) * a + weight * b; }

  [[nodiscard]] double of_dimension(std::size_t dimension, Term term) const {
    const auto of_samples = [&](std::size_t row) {
      const std::size_t first =
          (first_ + (dimension * terms + term) * sample_steps_ + row) * distance_steps + distance_.low;
      return mixed(distance_.weight, box_tree_table[first], box_tree_table[first + 1]);
    };
    return mixed(sample_.weight, of_samples(sample_.low), of_samples(sample_.low + 1));
  }

  std::size_t first_;
  std::size_t sample_steps_;
  Place sample_;
  Place distance_;
  double volume_weight_;
};

constexpr double most_in_a_leaf = 64;  // of sim/stream, where splitting does not pay
constexpr double most_distances = 0x1p6;

/// Σ P of the nodes, from the sums over so many bodies; by their mean, whose volume is no overflow yet.
double crossed(const Workload& workload, const Sums& sums, Term area, Term volume, double side, double bodies) {
  constexpr double largest = 1e300;
  return bodies * crossing_probability(workload, std::min(largest, sums[volume] / bodies * side * side * side),
                                       std::min(largest, sums[area] / bodies * side * side));
}

}  // namespace

bool is_tabulated(const BoxTreeParameters& tree) {
  return tree.fan_out == box_tree_fan_out &&
         std::find(box_tree_leaves.begin(), box_tree_leaves.end(), tree.leaf) != box_tree_leaves.end();
}

Counts<double> box_tree_counts(const Workload& workload, const BoxTreeParameters& parameters) {
  check(workload);
  check(Candidate{Technique::box_tree, parameters});
  if (!is_tabulated(parameters))
    throw std::invalid_argument(
        fmt::format("the closed form of a tree of boxes is for fan-out {} and {} samples a leaf "
                    "(got {})",
                    box_tree_fan_out, fmt::join(box_tree_leaves, ", "), describe({Technique::box_tree, parameters})));
  const double rays = workload.rays;
  const double samples = workload.samples;
  Counts<double> counts{
      .references = samples, .placements = samples, .sorted = samples, .hits = expected_hits(workload)};
  // One leaf, or discs that fill S₀, whose boxes keep no ray out and so are as few as may be.
  if (samples <= parameters.leaf || workload.disc_radius >= workload.sphere_radius) {
    counts.disc_tests = rays * samples;
    counts.visits = samples;
    counts.cull_tests = counts.listed = samples > most_in_a_leaf ? rays * samples / most_in_a_leaf : 0;
    return counts;
  }
  const double dimension = std::clamp(workload.dimension, 2.0, 3.0);
  // Where discs are larger by far than what is between them, they alone make the boxes.
  const double distance =
      std::max(std::pow(sample_extent(workload) / samples, 1 / dimension), workload.disc_radius / most_distances);
  const double side = distance * std::pow(samples / std::pow(6, 3 - dimension), 1 / dimension);
  const Sums sums(parameters.leaf, samples, workload.disc_radius / distance, dimension);
  const double tests = parameters.fan_out + crossed(workload, sums, inner_area, inner_volume, side, sums[nodes]);
  counts.cull_tests = rays * tests;
  counts.listed = rays * crossed(workload, sums, area, volume, side, sums[nodes]);
  counts.disc_tests = rays * std::min(samples, crossed(workload, sums, leaf_area, leaf_volume, side, samples));
  counts.culls = -sums[nodes] * std::expm1(-rays * tests / sums[nodes]);
  counts.visits = -samples * std::expm1(-counts.disc_tests / samples);
  return counts;
}

}  // namespace detp::model
