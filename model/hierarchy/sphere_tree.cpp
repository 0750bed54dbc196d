#include "sphere_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "detp/model/lines/line_measure.hpp"
#include "detp/model/sphere_cache/sample_spread.hpp"

namespace detp::model {
namespace {

constexpr std::array<double, 9> single_runs{2, 4, 8, 16, 32, 64, 256, 4096, 65536};
constexpr std::size_t single_steps = 57;  // of log₂N, each ¼
constexpr std::size_t nested_fan_outs = 4;
constexpr std::size_t nested_levels = 4;
constexpr std::size_t nested_steps = 25;  // of log₂N, each ½

#include "sphere_tree_tables.inc"

/// The two kinds of numbers in the tables.
enum Term : std::size_t { square_of_mean, mean_square };

/// Interpolates linearly between the entries of a row; `place` is counted in entries.
template <class Entry>
double between(double place, std::size_t entries, const Entry& entry) {
  const double last = static_cast<double>(entries - 1);
  const double at = std::clamp(place, 0.0, last);
  const auto low = static_cast<std::size_t>(std::min(std::floor(at), last - 1));
  const double weight = at - static_cast<double>(low);
  return (1 - weight) * entry(low) + weight * entry(low + 1);
}

/// Place of a run length among single_runs, by its logarithm.
double run_place(double run) {
  const auto next = std::find_if(single_runs.begin() + 1, single_runs.end() - 1, [&](double r) { return r >= run; });
  return static_cast<double>(next - single_runs.begin()) - std::log2(*next / run) / std::log2(*next / *(next - 1));
}

double single_entry(std::size_t dimension, Term term, double run, double step) {
  return between(run_place(run), single_runs.size(), [&](std::size_t row) {
    const std::size_t first = ((2 * (dimension - 2) + term) * single_runs.size() + row) * single_steps;
    return between(step, single_steps, [&](std::size_t column) { return single_table[first + column]; });
  });
}

/// R. Beyond the table, each further halving of the cells adds 2^{p-D} times what the previous halving added, where p
/// is 1 for <ρ>² and 2 for <ρ²>: the curve's additional jumps have this weight.
double single_radius(std::size_t dimension, Term term, double run, double log_runs) {
  if (run <= 1) return 0;
  constexpr double last = single_steps - 1;
  const double step = 4 * log_runs;
  if (step <= last) return single_entry(dimension, term, run, step);
  const double period = 4.0 * static_cast<double>(dimension);
  const double halvings = (step - last) / period;
  const double fall = std::exp2(static_cast<double>(term) + 1 - static_cast<double>(dimension));
  const double times = fall == 1 ? halvings : fall * (1 - std::pow(fall, halvings)) / (1 - fall);
  const double value = single_entry(dimension, term, run, last);
  return value + times * (value - single_entry(dimension, term, run, last - period));
}

/// K.
double nested_growth(std::size_t dimension, Term term, double fan_out, double level, double log_runs) {
  if (level <= 0) return 1;
  return between(std::log2(fan_out) - 1, nested_fan_outs, [&](std::size_t f) {
    return between(std::log2(level), nested_levels, [&](std::size_t l) {
      const std::size_t row = ((2 * (dimension - 2) + term) * nested_fan_outs + f) * nested_levels + l;
      return between(2 * log_runs, nested_steps,
                     [&](std::size_t column) { return nested_table[row * nested_steps + column]; });
    });
  });
}

/// <ρ>² or <ρ²>.
double radius(const Valid<Workload>& workload, const SphereTreeParameters& parameters, Term term, double run,
              double level) {
  const double runs = workload.samples / run;
  const double dimension = std::clamp(workload.dimension, 2.0, 3.0);
  const auto of_dimension = [&](std::size_t d) {
    const double shape = single_radius(d, term, run, std::log2(runs));
    return shape * nested_growth(d, term, parameters.fan_out, level, std::log2(runs));
  };
  const double shape = dimension == 2 ? of_dimension(2)
                       : dimension == 3
                           ? of_dimension(3)
                           : std::pow(of_dimension(2), 3 - dimension) * std::pow(of_dimension(3), dimension - 2);
  const double cube = sample_extent(workload) / std::pow(6, 3 - dimension);
  return shape * std::pow(cube / runs, 2 / dimension);
}

/// <ρ²> of all samples without nesting; only for lines.
double radius_around_all(const Valid<Workload>& workload) {
  return workload.path_length > 0 ? 0 : radius(workload, {}, mean_square, workload.samples, 0);
}

/// P(node) for a sphere of radius r around a run.
double crossed(const Valid<Workload>& workload, double around_all, double run, double r) {
  using std::numbers::pi;
  if (workload.path_length > 0) {
    const double bounded = std::min(r, 1e99);  // so that the volume does not overflow
    return crossing_probability(workload, 4 * pi / 3 * bounded * bounded * bounded, 4 * pi * bounded * bounded);
  }
  const double around_run = radius(workload, {}, mean_square, run, 0);
  const double inside = around_all > 0 ? std::min(1.0, around_run / around_all) : 1;
  const double offset = std::sqrt(mean_square_distance(workload) * (1 - inside));
  if (r >= workload.sphere_radius + offset) return 1;  // it contains S₀
  const double ratio = r / workload.sphere_radius;
  return std::min(1.0, ratio * ratio * both_hit_share(workload.sphere_radius, r, offset));
}

TreeLevel level_of(const Valid<Workload>& workload, const SphereTreeParameters& parameters, double around_all,
                   double run, double level) {
  const double d = largest_radius(workload, run);
  const double square = radius(workload, parameters, mean_square, run, level);
  // Near the root all spheres are about equal. Rounding in the tables must not make their mean larger than the root of
  // their mean square.
  const double mean = std::sqrt(std::min(square, radius(workload, parameters, square_of_mean, run, level)));
  const long double moment = square + d * (2.0L * mean + d);  // in doubles the square of d may be 0 or overflow
  const double r = std::max(d, static_cast<double>(std::sqrt(moment)));
  return {.nodes = std::ceil(workload.samples / run),
          .samples = run,
          .rms_radius = r,
          .rays = workload.rays * crossed(workload, around_all, run, r)};
}

}  // namespace

std::vector<TreeLevel> sphere_tree_levels(const Valid<Workload>& workload,
                                          const Valid<SphereTreeParameters>& parameters) {
  std::vector<TreeLevel> levels;
  double run = std::min<double>(parameters.leaf, workload.samples);
  const double around_all = radius_around_all(workload);
  // A sphere around a single sample has no extent. So if leaves have one sample, they are level -1, and the nesting of
  // spheres starts above them.
  for (double level = parameters.leaf == 1 ? -1 : 0;;
       ++level, run = std::min(run * parameters.fan_out, workload.samples)) {
    levels.push_back(level_of(workload, parameters, around_all, run, level));
    if (run >= workload.samples) break;
  }
  std::reverse(levels.begin(), levels.end());
  for (std::size_t i = 1; i < levels.size(); ++i) levels[i].rays = std::min(levels[i].rays, levels[i - 1].rays);
  return levels;
}

Counts<double> sphere_tree_counts(const Valid<Workload>& workload, const Valid<SphereTreeParameters>& parameters) {
  Counts<double> counts{.sorted = workload.samples, .hits = expected_hits(workload)};
  double around = workload.rays;
  for (const TreeLevel& level : sphere_tree_levels(workload, parameters)) {
    counts.culls += level.nodes * -std::expm1(-around);  // nodes whose parent's list holds at least one ray
    counts.cull_tests += level.nodes * around;
    counts.made += level.nodes;
    counts.listed += workload.samples / level.samples * level.rays;
    around = level.rays;
  }
  counts.visits = workload.samples * -std::expm1(-around);
  counts.disc_tests = workload.samples * around;
  return counts;
}

}  // namespace detp::model
