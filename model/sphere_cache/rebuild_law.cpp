#include "rebuild_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string_view>

namespace detp::model {
namespace {

constexpr std::size_t phases = 32;
constexpr int least_power = -9;
constexpr std::size_t single_rows = 23;
constexpr std::size_t columns = 5;          // 10³ … 10⁷ samples
constexpr std::size_t coarse_columns = 17;  // 10³ … 10⁷ samples, four columns a decade
constexpr double coarse_from = -1;
constexpr double coarse_to = 4.5;  // the effect fades out over the last half halving before this
constexpr std::size_t coarse_phases = 64;
constexpr std::size_t coarse_steps = 353;
constexpr double chain_from = 0.5;
constexpr std::array<std::size_t, 2> dense_chain_steps{401, 305};  // number in the last column
constexpr std::size_t chain_steps = 129;                           // number in the other columns
constexpr std::array octave_steps{2.,  3.,  4.,  5.,  6.,  7.,  8.,  10., 12., 14., 16., 18.,
                                  20., 22., 24., 26., 28., 30., 32., 36., 40., 48., 56., 72.};  // u, in units of 1/32

#include "rebuild_law_tables.inc"

static_assert(coarse_table.size() == 2 * 2 * coarse_columns * coarse_steps);
static_assert(chain_table.size() ==
              (8 * chain_steps + dense_chain_steps[0] + dense_chain_steps[1]) * octave_steps.size());

/// A digit of base 90: the characters from '#' on, without the question mark and the backslash.
int digit(char character) { return character - '#' - (character > '?' ? 1 : 0) - (character > '\\' ? 1 : 0); }

double mix(double a, double b, double weight) { return (1 - weight) * a + weight * b; }

double weight_of_volume(double dimension) { return std::clamp(dimension - 2, 0.0, 1.0); }

/// Interpolates a law between surfaces (2) and volumes (3).
template <class Law>
double between_dimensions(double dimension, const Law& law) {
  const double weight = weight_of_volume(dimension);
  if (weight <= 0) return law(2);
  return weight >= 1 ? law(3) : mix(law(2), law(3), weight);
}

/// ln(m/n) at a tabulated phase. Rows are by λ 2^{Dφ}, so that one set of samples gives all phases.
double log_share_at(int dimension, double log_lambda, std::size_t phase) {
  const auto at = [&](std::size_t row) {
    return single_table[(static_cast<std::size_t>(dimension - 2) * single_rows + row) * phases + phase];
  };
  constexpr double last = single_rows - 1;
  const double place = log_lambda + dimension * static_cast<double>(phase) / phases - least_power;
  if (place <= 0) return at(0) * std::exp2(place);  // 1 - m/n is proportional to λ
  if (place >= last) return at(single_rows - 1) - (place - last) * std::numbers::ln2;
  const auto row = static_cast<std::size_t>(place);
  return mix(at(row), at(row + 1), place - static_cast<double>(row));
}

/// log₂ λ; λ below the range of doubles is clamped.
double log_of(double lambda) { return std::log2(std::max(lambda, 1e-300)); }

/// ln(m/n) of surfaces (2) or volumes (3), linear between the phases, which are periodic.
double log_share(int dimension, double log_lambda, double phase) {
  const double place = phase * phases;
  const auto left = static_cast<std::size_t>(place) % phases;
  return mix(log_share_at(dimension, log_lambda, left), log_share_at(dimension, log_lambda, (left + 1) % phases),
             place - std::floor(place));
}

/// log₂ of the cube's volume (in cubes of its side) or surface (in squares of its side).
double log_extent(int dimension) { return dimension == 3 ? 0 : 2.584962500721156; }

constexpr double log2_of_10 = 3.321928094887362;

/// The place among a table's columns, in decades above 10³, of the number of samples that the whole cube would hold at
/// this λ. The last column is 10⁷.
double decades_of(int dimension, double log_lambda, double halvings) {
  const double log_samples = log_lambda + log_extent(dimension) + dimension * halvings;
  return std::clamp(log_samples / log2_of_10 - 3, 0.0, columns - 1.0);
}

/// ln(count of a large ball / law of small balls), for the number of samples of one column of the table.
double coarse_column(int dimension, std::size_t column, double halvings) {
  const double place = std::max(halvings - coarse_from, 0.0) * coarse_phases;
  const auto step = std::min(static_cast<std::size_t>(place), coarse_steps - 2);
  const std::size_t first = (static_cast<std::size_t>(dimension - 2) * coarse_columns + column) * coarse_steps;
  const auto at = [&](std::size_t entry) {
    return (90 * digit(coarse_table[2 * (first + entry)]) + digit(coarse_table[2 * (first + entry) + 1])) / 500.0;
  };
  const double counted = mix(at(step), at(step + 1), place - static_cast<double>(step));
  const double log_samples = (3 + static_cast<double>(column) / 4) * log2_of_10;
  const double log_lambda = log_samples - dimension * halvings - log_extent(dimension);
  return counted - log_samples * std::numbers::ln2 - log_share(dimension, log_lambda, halvings - std::floor(halvings));
}

double log_coarse_factor(int dimension, double log_lambda, double halvings) {
  if (halvings >= coarse_to) return 0;
  const double place = 4 * decades_of(dimension, log_lambda, halvings);
  const auto column = std::min(static_cast<std::size_t>(place), coarse_columns - 2);
  const double factor = mix(coarse_column(dimension, column, halvings), coarse_column(dimension, column + 1, halvings),
                            place - static_cast<double>(column));
  return factor * std::min(1.0, 2 * (coarse_to - halvings));
}

/// Probability that two uniform points of a unit cube are within t of each other.
///
/// Exact for t <= 1 (cube line picking); beyond, a cubic that reaches 1 at √3, with an error below 0.01.
double cube_distance_cdf(double t) {
  using std::numbers::pi;
  if (t <= 1) return t * t * t * (4 * pi / 3 - 1.5 * pi * t + 1.6 * t * t - t * t * t / 6);
  const double rest = std::max(0.0, (std::sqrt(3.0) - t) / (std::sqrt(3.0) - 1));
  return 1 - (1 - cube_distance_cdf(1)) * rest * rest * rest;
}

/// Share of the samples within ρ of a random sample.
double share_within(const Valid<Workload>& workload, double radius) {
  const double in_cube = cube_distance_cdf(radius / scene_side(workload));
  const double on_surface = 1 - std::exp(-std::numbers::pi * radius * radius / sample_extent(workload));
  const double weight = weight_of_volume(workload.dimension);
  return std::pow(in_cube, weight) * std::pow(on_surface, 1 - weight);
}

void require_dimension(double dimension) {
  if (!(dimension >= 1 && dimension <= 3))
    throw std::invalid_argument(fmt::format("sample dimension must be from 1 to 3 (got {})", dimension));
}

void require_share(std::string_view what, double value) {
  if (!(value >= 0 && value <= 1))
    throw std::invalid_argument(fmt::format("{} must be from 0 to 1 (got {})", what, value));
}

/// b from a digit of the table; the digit is 90 b/(1 + b).
double tabulated_b(std::size_t row, std::size_t octaves) {
  const int ninetieths = digit(chain_table[row * octave_steps.size() + octaves]);
  return ninetieths / (90.0 - ninetieths);
}

/// b of a column, linear between its halvings and its octaves.
double chain_column(int dimension, std::size_t column, double halvings, double octaves) {
  const std::size_t surfaces = (columns - 1) * chain_steps + dense_chain_steps[0];
  const std::size_t first = (dimension == 3 ? surfaces : 0) + column * chain_steps;
  const std::size_t steps = column + 1 < columns ? chain_steps : dense_chain_steps[dimension == 3 ? 1 : 0];
  const double place = std::clamp((halvings - chain_from) * phases, 0.0, static_cast<double>(steps - 1));
  const auto step = std::min(static_cast<std::size_t>(place), steps - 2);
  const double u = std::clamp(32 * octaves, octave_steps.front(), octave_steps.back());
  std::size_t i = 0;
  while (i + 2 < octave_steps.size() && u > octave_steps[i + 1]) ++i;
  const double weight = (u - octave_steps[i]) / (octave_steps[i + 1] - octave_steps[i]);
  const auto at = [&](std::size_t row) { return mix(tabulated_b(row, i), tabulated_b(row, i + 1), weight); };
  return mix(at(first + step), at(first + step + 1), place - static_cast<double>(step));
}

/// b of a large ball, interpolated between the columns by the number of samples.
double large_ball_b(int dimension, double log_lambda, double halvings, double octaves) {
  const double place = decades_of(dimension, log_lambda, halvings);
  const auto column = std::min(static_cast<std::size_t>(place), columns - 2);
  return mix(chain_column(dimension, column, halvings, octaves), chain_column(dimension, column + 1, halvings, octaves),
             place - static_cast<double>(column));
}

/// b of a small ball, from the column of 10⁷ samples. In this column, balls with this λ have `same_lambda` halvings. b
/// is interpolated between the next smaller and the next larger number of halvings with the ball's phase.
double small_ball_b(int dimension, double log_lambda, double halvings, double octaves) {
  constexpr double least = coarse_to - 0.5;
  const double same_lambda = (7 * log2_of_10 - log_extent(dimension) - log_lambda) / dimension;
  const double phase = halvings - std::floor(halvings);
  const double place = std::clamp(same_lambda - phase, least, 20.0);
  const double above = std::floor(place) + phase;
  return mix(chain_column(dimension, columns - 1, above, octaves),
             chain_column(dimension, columns - 1, above + 1, octaves), place - std::floor(place));
}

double chain_b(int dimension, const Ball& ball, double octaves) {
  const double log_lambda = log_of(ball.lambda);
  const double large = std::clamp(2 * (coarse_to - ball.halvings), 0.0, 1.0);
  if (large <= 0) return small_ball_b(dimension, log_lambda, ball.halvings, octaves);
  if (large >= 1) return large_ball_b(dimension, log_lambda, ball.halvings, octaves);
  return mix(small_ball_b(dimension, log_lambda, ball.halvings, octaves),
             large_ball_b(dimension, log_lambda, ball.halvings, octaves), large);
}

constexpr double least_octaves = 1.0 / 16;

/// The crowding x = m_{i-1}/s_i in a nest with the smallest tabulated ratio whose balls hold many samples. Because
/// m ∝ ρ^{-D}, x (2^{D/16} - 1) = e^{-bx}; solved by Newton's method.
double crowding_of_nest(int dimension, double b) {
  const double growth = std::exp2(dimension * least_octaves) - 1;
  double x = 0;
  for (int step = 0; step < 6; ++step) {
    const double remaining = std::exp(-b * x);
    x += (remaining - growth * x) / (growth + b * remaining);
  }
  return x;
}

double own_share(int dimension, const Ball& ball, double octaves, double crowding) {
  const double b = chain_b(dimension, ball, octaves);
  if (octaves >= least_octaves) return std::exp(-b * crowding);
  const double apart = (dimension == 3 ? 0.45 : 0.9) * std::pow(std::max(ball.lambda, 1e-9), -1.0 / dimension);
  const double lowered = std::expm1(-octaves / apart) / std::expm1(-least_octaves / apart);
  return lowered * std::exp(-b * std::min(crowding, crowding_of_nest(dimension, b)));
}

}  // namespace

Ball ball_of(const Valid<Workload>& workload, double radius) {
  require_positive("radius of the ball", radius);
  const double lambda = workload.samples * std::pow(radius, workload.dimension) / sample_extent(workload);
  return {std::min(lambda, 1e300), std::log2(scene_side(workload)) - std::log2(radius)};
}

double single_rebuilds(double dimension, double samples, const Ball& ball) {
  require_dimension(dimension);
  require_positive("number of samples", samples);
  require_non_negative("samples per ball", ball.lambda);
  require_finite("halvings", ball.halvings);
  if (ball.halvings < coarse_from) return 1;
  const double phase = ball.halvings - std::floor(ball.halvings);
  const double log_lambda = log_of(ball.lambda);
  const double log_rebuilds = between_dimensions(dimension, [&](int d) {
    return log_share(d, log_lambda, phase) + log_coarse_factor(d, log_lambda, ball.halvings);
  });
  return std::max(1.0, std::min(samples, samples * std::exp(log_rebuilds)));
}

void require_rebuild_law(SampleOrder order) {
  if (order == SampleOrder::hilbert)
    throw std::invalid_argument(
        "the closed forms predict rebuilds along the Morton (lebesgue) curve or without sorting, not along the Hilbert "
        "curve; use order lebesgue or none");
}

double single_rebuilds(const Valid<Workload>& workload, double radius, SampleOrder order) {
  require_rebuild_law(order);
  require_finite("radius of the ball", radius);
  if (order == SampleOrder::lebesgue && radius > 0)
    return single_rebuilds(workload.dimension, workload.samples, ball_of(workload, radius));
  return radius > 0 ? std::max(1.0, workload.samples * (1 - share_within(workload, radius))) : workload.samples;
}

double own_rebuild_share(double dimension, const Ball& ball, double octaves, double crowding) {
  require_dimension(dimension);
  require_non_negative("samples per ball", ball.lambda);
  require_finite("halvings", ball.halvings);
  require_non_negative("octaves between the balls", octaves);
  require_non_negative("crowding", crowding);
  return between_dimensions(dimension, [&](int d) { return own_share(d, ball, octaves, crowding); });
}

double nested_rebuilds(double alone, double outer, double own_share, double samples) {
  require_non_negative("rebuilds of the sphere alone", alone);
  require_non_negative("rebuilds of the outer sphere", outer);
  require_share("share of own rebuilds", own_share);
  require_positive("number of samples", samples);
  const double free = std::max(0.0, 1 - outer / samples);
  return std::min(samples, outer + std::min(alone, samples) * own_share * free);
}

}  // namespace detp::model
