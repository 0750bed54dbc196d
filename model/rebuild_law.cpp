#include "rebuild_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace detp::model {
namespace {

constexpr int phases = 8;
constexpr int least_power = -9;
constexpr int rows = 22;

constexpr std::array<double, 2 * rows * phases> table{
#include "rebuild_law_table.inc"
};

/// ln(m/n) at a row of the table, linear between its phases, which wrap around.
double at_row(int dimension, int row, double phase) {
  const double place = phase * phases;
  const int left = static_cast<int>(place) % phases;
  const double weight = place - std::floor(place);
  const auto entry = [&](int column) {
    return table[static_cast<std::size_t>(((dimension - 2) * rows + row) * phases + column)];
  };
  return (1 - weight) * entry(left) + weight * entry((left + 1) % phases);
}

/// ln(m/n) of surfaces (2) or volumes (3).
double log_share(int dimension, double lambda, double phase) {
  const double place = std::log2(std::max(lambda, 1e-300)) - least_power;
  if (place <= 0) return at_row(dimension, 0, phase) * std::exp2(place);  // 1 - m/n ∝ λ
  if (place >= rows - 1) return at_row(dimension, rows - 1, phase) - (place - (rows - 1)) * std::numbers::ln2;
  const int row = static_cast<int>(place);
  const double weight = place - row;
  return (1 - weight) * at_row(dimension, row, phase) + weight * at_row(dimension, row + 1, phase);
}

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
  const double weight = std::clamp(workload.dimension - 2, 0.0, 1.0);
  return std::pow(in_cube, weight) * std::pow(on_surface, 1 - weight);
}

void require_dimension(double dimension) {
  if (!(dimension >= 1 && dimension <= 3))
    throw std::invalid_argument(fmt::format("sample dimension must be from 1 to 3 (got {})", dimension));
}

double interpolate(const std::array<double, 7>& x, const std::array<double, 7>& y, double at) {
  std::size_t i = 1;
  while (i + 1 < x.size() && at > x[i]) ++i;
  const double weight = std::clamp((at - x[i - 1]) / (x[i] - x[i - 1]), 0.0, 1.0);
  return (1 - weight) * y[i - 1] + weight * y[i];
}

}  // namespace

double single_rebuild_share(double dimension, double lambda, double phase) {
  require_non_negative("samples per ball", lambda);
  if (!(phase >= 0 && phase <= 1))
    throw std::invalid_argument(fmt::format("phase must be from 0 to 1 (got {})", phase));
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
  return std::max(1.0, n * single_rebuild_share(workload.dimension, lambda, halvings - std::floor(halvings)));
}

double chain_share(double dimension, RadiusRatio ratio) {
  require_dimension(dimension);
  require_ratio("radius ratio Q", ratio.value);
  constexpr std::array<double, 7> q{0, 0.3, 0.5, 0.65, 0.8, 0.9, 1};
  constexpr std::array<double, 7> volume{0, 0.3, 0.32, 0.6, 0.65, 0.77, 1};
  constexpr std::array<double, 7> surface{0, 0.45, 0.4, 0.5, 0.6, 0.73, 1};
  const double weight = std::clamp(dimension - 2, 0.0, 1.0);
  return weight * interpolate(q, volume, ratio.value) + (1 - weight) * interpolate(q, surface, ratio.value);
}

double chained_rebuilds(double alone, double outer, double share, double samples) {
  require_non_negative("rebuilds of the sphere alone", alone);
  require_non_negative("rebuilds of the outer sphere", outer);
  require_non_negative("share that chains", share);
  require_positive("number of samples", samples);
  return std::min(samples, (alone + share * outer) / (1 + share * outer / samples));
}

}  // namespace detp::model
