#include "rebuild_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace detp::model {
namespace {

constexpr std::size_t phases = 16;
constexpr int least_power = -9;
constexpr std::size_t single_rows = 22;
constexpr std::size_t coarse_counts = 5;
constexpr std::size_t coarse_steps = 81;
constexpr double coarse_from = -1;
constexpr double coarse_to = 4;
constexpr std::array chain_ratios{0.2, 0.3, 0.4, 0.5, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95};

#include "rebuild_law_tables.inc"

double mix(double a, double b, double weight) { return (1 - weight) * a + weight * b; }

/// A row of a table at a phase in [0, 1], linear between its columns, which wrap around.
double at_phase(const double* row, double phase) {
  const double place = phase * phases;
  const auto left = static_cast<std::size_t>(place) % phases;
  return mix(row[left], row[(left + 1) % phases], place - std::floor(place));
}

double single_row(int dimension, std::size_t row, double phase) {
  return at_phase(&single_table[(static_cast<std::size_t>(dimension - 2) * single_rows + row) * phases], phase);
}

/// ln(m/n) of surfaces (2) or volumes (3).
double log_share(int dimension, double lambda, double phase) {
  constexpr double last = single_rows - 1;
  const double place = std::log2(std::max(lambda, 1e-300)) - least_power;
  if (place <= 0) return single_row(dimension, 0, phase) * std::exp2(place);  // 1 - m/n ∝ λ
  if (place >= last) return single_row(dimension, single_rows - 1, phase) - (place - last) * std::numbers::ln2;
  const auto row = static_cast<std::size_t>(place);
  return mix(single_row(dimension, row, phase), single_row(dimension, row + 1, phase), place - std::floor(place));
}

/// ln of a large ball's count among as many samples as a column of the table stands for, over the law of small balls.
double coarse_column(int dimension, std::size_t column, double halvings, double extent) {
  const double place = (std::max(halvings, coarse_from) - coarse_from) / (coarse_to - coarse_from) * (coarse_steps - 1);
  const auto step = std::min(static_cast<std::size_t>(place), coarse_steps - 2);
  const double* row = &coarse_table[(static_cast<std::size_t>(dimension - 2) * coarse_counts + column) * coarse_steps];
  const double counted = mix(row[step], row[step + 1], place - static_cast<double>(step));
  const double samples = std::pow(10.0, 3 + static_cast<double>(column));
  const double lambda = samples * std::exp2(-dimension * halvings) / extent;
  return counted - std::log(samples) - log_share(dimension, lambda, halvings - std::floor(halvings));
}

/// The same, between the columns by the samples that the cube would hold at this density.
double log_coarse_factor(int dimension, double halvings, double lambda) {
  if (halvings >= coarse_to) return 0;
  const double extent = dimension == 3 ? 1 : 6;  // in cubes or squares of the side
  const double log_samples = std::log10(std::max(lambda, 1e-300) * extent) + dimension * halvings * std::log10(2.0);
  const double place = std::clamp(log_samples - 3, 0.0, coarse_counts - 1.0);
  const auto column = std::min(static_cast<std::size_t>(place), coarse_counts - 2);
  const double factor =
      mix(coarse_column(dimension, column, halvings, extent), coarse_column(dimension, column + 1, halvings, extent),
          place - static_cast<double>(column));
  return factor * std::min(1.0, coarse_to - halvings);
}

double weight_of_volume(double dimension) { return std::clamp(dimension - 2, 0.0, 1.0); }

/// Probability that two uniform points of a unit cube lie within t of each other.
///
/// Exact for t <= 1 (cube line picking); beyond, a cubic to 1 at √3, off by less than 0.01.
double cube_distance_cdf(double t) {
  using std::numbers::pi;
  if (t <= 1) return t * t * t * (4 * pi / 3 - 1.5 * pi * t + 1.6 * t * t - t * t * t / 6);
  const double rest = std::max(0.0, (std::sqrt(3.0) - t) / (std::sqrt(3.0) - 1));
  return 1 - (1 - cube_distance_cdf(1)) * rest * rest * rest;
}

/// Share of the samples within ρ of a random one.
double share_within(const Workload& workload, double radius) {
  const double in_cube = cube_distance_cdf(radius / scene_side(workload));
  const double on_surface = 1 - std::exp(-std::numbers::pi * radius * radius / sample_extent(workload));
  const double weight = weight_of_volume(workload.dimension);
  return std::pow(in_cube, weight) * std::pow(on_surface, 1 - weight);
}

void require_dimension(double dimension) {
  if (!(dimension >= 1 && dimension <= 3))
    throw std::invalid_argument(fmt::format("sample dimension must be from 1 to 3 (got {})", dimension));
}

/// The share that chains, for many samples a ball; 1 for balls all alike.
double dense_chain_share(int dimension, double ratio, double phase) {
  constexpr double half_bin = 0.5 / phases;  // the columns are means over a sixteenth of a phase
  const double place = phase >= half_bin ? phase - half_bin : phase - half_bin + 1;
  const auto at = [&](std::size_t i) {
    return at_phase(&chain_table[(static_cast<std::size_t>(dimension - 2) * chain_ratios.size() + i) * phases], place);
  };
  if (ratio >= chain_ratios.back())
    return mix(at(chain_ratios.size() - 1), 1, (ratio - chain_ratios.back()) / (1 - chain_ratios.back()));
  if (ratio <= chain_ratios.front()) return at(0);
  std::size_t i = 1;
  while (ratio > chain_ratios[i]) ++i;
  return mix(at(i - 1), at(i), (ratio - chain_ratios[i - 1]) / (chain_ratios[i] - chain_ratios[i - 1]));
}

void require_share(std::string_view what, double value) {
  if (!(value >= 0 && value <= 1))
    throw std::invalid_argument(fmt::format("{} must be from 0 to 1 (got {})", what, value));
}

}  // namespace

double single_rebuild_share(double dimension, double lambda, double phase) {
  require_non_negative("samples per ball", lambda);
  require_share("phase", phase);
  require_dimension(dimension);
  const double weight = std::max(dimension - 2, 0.0);
  return std::exp((1 - weight) * log_share(2, lambda, phase) + weight * log_share(3, lambda, phase));
}

double single_rebuilds(const Workload& workload, double radius, SampleOrder order) {
  check(workload);
  require_finite("radius of the ball", radius);
  const double n = workload.samples;
  if (radius <= 0) return n;
  if (order == SampleOrder::none) return std::max(1.0, n * (1 - share_within(workload, radius)));
  const double halvings = std::log2(scene_side(workload) / radius);
  if (halvings < -1) return 1;
  const double lambda = n * std::pow(radius, workload.dimension) / sample_extent(workload);
  const double share = single_rebuild_share(workload.dimension, lambda, halvings - std::floor(halvings));
  const double weight = weight_of_volume(workload.dimension);
  const double coarse = mix(log_coarse_factor(2, halvings, lambda), log_coarse_factor(3, halvings, lambda), weight);
  return std::clamp(n * share * std::exp(coarse), 1.0, n);
}

double chain_share(double dimension, double ratio, double halvings, double alone) {
  require_dimension(dimension);
  require_share("ratio of the balls", ratio);
  require_finite("halvings", halvings);
  require_share("share of rebuilds", alone);
  const double weight = weight_of_volume(dimension);
  const double phase = halvings - std::floor(halvings);
  const double dense = mix(dense_chain_share(2, ratio, phase), dense_chain_share(3, ratio, phase), weight);
  const double sparse = 1 - mix(0.5, 0.33, weight) * std::pow(alone, 4);
  const double large = 1 - mix(0.4, 0.1, weight) * std::min(1.0, std::exp2(-halvings));
  return dense * sparse * large;
}

double chained_rebuilds(double alone, double outer, double share, double samples) {
  require_non_negative("rebuilds of the sphere alone", alone);
  require_non_negative("rebuilds of the outer sphere", outer);
  require_non_negative("share that chains", share);
  require_positive("number of samples", samples);
  return std::min(samples, (alone + share * outer) / (1 + share * outer / samples));
}

}  // namespace detp::model
