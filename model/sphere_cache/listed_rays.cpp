#include "listed_rays.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "detp/model/lines/line_measure.hpp"

namespace detp::model {
namespace {

constexpr std::array octave_grid{0.074, 0.152, 0.234, 0.322, 0.42, 0.515, 0.62, 0.737, 1.0, 1.32, 1.74, 2.32};
constexpr std::array disc_shares{0.0, 0.1, 0.25, 0.45, 0.65, 0.85, 1.0};  // d/r_i
constexpr std::array outer_disc_shares{0.0, 0.05, 0.2};                   // d/r₀
constexpr std::size_t densities = 13;                                     // λ = 2⁻¹², 2⁻¹⁰ … 2¹²
constexpr double least_power = -12;
constexpr std::size_t depths = 16;  // log₂(r₀/r_i) = 1/4, 2/4 … 4
constexpr double shallow_to = 4;    // the effect fades out over the last half octave before this
constexpr std::array shallow_samples{1e3, 1e5};

#include "listed_rays_tables.inc"

/// The place of a value on a grid: between two points, or (with a weight below 0) below the first point.
struct Place {
  std::size_t left = 0;
  double weight = 0;

  template <class At>
  [[nodiscard]] double mix(const At& at) const {
    return (1 - weight) * at(left) + weight * at(left + 1);
  }
};

template <std::size_t size>
Place place_on(const std::array<double, size>& grid, double value) {
  std::size_t i = 0;
  while (i + 2 < size && value > grid[i + 1]) ++i;
  return {i, std::min(1.0, (value - grid[i]) / (grid[i + 1] - grid[i]))};
}

Place place_on(std::size_t size, double value) {
  const double inside = std::clamp(value, 0.0, static_cast<double>(size - 1));
  const std::size_t left = std::min(static_cast<std::size_t>(inside), size - 2);
  return {left, inside - static_cast<double>(left)};
}

/// Share of rays that are not listed, for a sphere far inside S₀.
double deep(int dimension, double log_lambda, const Place& octaves, double disc_share) {
  const Place density = place_on(densities, (log_lambda - least_power) / 2);
  const Place disc = place_on(disc_shares, disc_share);
  const double lost = density.mix([&](std::size_t i) {
    return octaves.mix([&](std::size_t j) {
      const std::size_t row = (static_cast<std::size_t>(dimension - 2) * densities + i) * octave_grid.size() + j;
      return disc.mix([&](std::size_t k) { return deep_table[row * disc_shares.size() + k]; });
    });
  });
  // With fewer samples, all spheres of about this size share their centres. The exponent is fitted.
  return lost * std::exp2(std::min(0.0, log_lambda - least_power) * 1.4 / dimension);
}

/// log₂(r_i/s) for the cubes from which the tables were made.
double in_sides(double outer_disc, double depth) { return std::log2(std::sqrt(0.75) / (1 - outer_disc)) - depth; }

/// log₂ of the cube's volume (in cubes of its side) or surface (in squares of its side).
double log_extent(int dimension) { return dimension == 3 ? 0 : std::log2(6.0); }

/// The additional share lost near S₀, in one column of the table.
double added_near(int dimension, std::size_t count, std::size_t disc, double depth, const Place& octaves) {
  const std::size_t columns =
      (static_cast<std::size_t>(dimension - 2) * shallow_samples.size() + count) * outer_disc_shares.size() + disc;
  const double lost = place_on(depths, 4 * depth - 1).mix([&](std::size_t i) {
    return octaves.mix([&](std::size_t j) { return shallow_table[(columns * depths + i) * octave_grid.size() + j]; });
  });
  const double outer_disc = outer_disc_shares[disc];
  const double log_lambda =
      std::log2(shallow_samples[count]) - log_extent(dimension) + dimension * in_sides(outer_disc, depth);
  return lost - deep(dimension, log_lambda, octaves, std::min(1.0, outer_disc * std::exp2(depth)));
}

double near_outermost(int dimension, double log_lambda, double outer_disc, double depth, const Place& octaves) {
  if (depth >= shallow_to) return 0;
  const double log_samples =
      log_lambda - dimension * in_sides(std::min(outer_disc, 0.5), depth) + log_extent(dimension);
  const double few = std::log2(shallow_samples[0]);
  const Place count = place_on(shallow_samples.size(), (log_samples - few) / (std::log2(shallow_samples[1]) - few));
  const Place disc = place_on(outer_disc_shares, outer_disc);
  const double added = count.mix([&](std::size_t i) {
    return disc.mix([&](std::size_t j) { return added_near(dimension, i, j, depth, octaves); });
  });
  // Beyond the table: the closer d is to r₀, the closer the spheres' centres are to that of S₀.
  const double rest = std::min(1.0, (1 - outer_disc) / (1 - outer_disc_shares.back()));
  return added * rest * std::min(1.0, 2 * (shallow_to - depth));
}

/// A table of H(r_i/r_l, reach_l/r_l), the mean share in unsorted_listed_share. Both arguments are in [0, 1]; values
/// between the grid's points are interpolated.
class OffsetShares {
 public:
  OffsetShares() {
    for (std::size_t i = 0; i <= sizes; ++i)
      for (std::size_t j = 0; j <= reaches; ++j)
        values_[i * (reaches + 1) + j] = average(static_cast<double>(i) / sizes, static_cast<double>(j) / reaches);
  }

  [[nodiscard]] double operator()(double size, double reach) const {
    const Place x = place_on(sizes + 1, size * sizes);
    const Place y = place_on(reaches + 1, reach * reaches);
    return x.mix([&](std::size_t i) { return y.mix([&](std::size_t j) { return values_[i * (reaches + 1) + j]; }); });
  }

 private:
  static constexpr std::size_t sizes = 32;
  static constexpr std::size_t reaches = 16;

  static double average(double size, double reach) {
    constexpr int offsets = 8;
    double sum = 0;
    for (int i = 0; i < offsets; ++i)
      sum += both_hit_share(1, std::max(size, 1e-6), reach * std::sqrt((i + 0.5) / offsets));
    return sum / offsets;
  }

  std::array<double, (sizes + 1) * (reaches + 1)> values_{};
};

}  // namespace

double rays_through(const Valid<Workload>& workload, double radius) {
  using std::numbers::pi;
  require_non_negative("sphere radius", radius);
  return workload.rays *
         crossing_probability(workload, 4 * pi / 3 * radius * radius * radius, 4 * pi * radius * radius);
}

double listed_share(const Valid<Workload>& workload, double radius, double octaves) {
  require_non_negative("sphere radius", radius);
  require_non_negative("octaves between the spheres", octaves);
  if (radius <= workload.disc_radius * (1 + 1e-15)) return 1;
  const double inside = std::min(1.0, radius / workload.sphere_radius);
  const double depth = -std::log2(inside);
  const double log_lambda =
      std::log2(workload.samples / sample_extent(workload)) + workload.dimension * std::log2(radius);
  const Place place = place_on(octave_grid, octaves);
  // the lost share is proportional to Q², as in the table
  const double farther = std::exp2(-2 * std::max(0.0, octaves - octave_grid.back()));
  const double outer_disc = std::min(1.0, workload.disc_radius / workload.sphere_radius);
  const auto lost = [&](int dimension) {
    const double far = deep(dimension, log_lambda, place, workload.disc_radius / radius);
    return farther * far + near_outermost(dimension, log_lambda, outer_disc, depth, place);
  };
  const double volume = std::clamp(workload.dimension - 2, 0.0, 1.0);
  const double lost_share = (volume < 1 ? (1 - volume) * lost(2) : 0) + (volume > 0 ? volume * lost(3) : 0);
  return std::clamp(1 - lost_share, 0.0, 1.0);
}

double unsorted_listed_share(double radius, double rebuilds, const std::vector<EnclosingSphere>& around) {
  require_non_negative("sphere radius", radius);
  require_positive("rebuilds of the sphere", rebuilds);
  static const OffsetShares offset_shares;
  double product = 1;
  double least = 1;
  for (const EnclosingSphere& outer : around) {
    require_non_negative("sphere radius", outer.radius);
    require_non_negative("rebuilds of the outer sphere", outer.rebuilds);
    const double concentric = std::min(1.0, outer.rebuilds / rebuilds);
    require_non_negative("reach of the offsets", outer.reach);
    const double size = outer.radius > 0 ? radius / outer.radius : 1;  // both may be too small for a double
    const double reach = outer.radius > 0 ? outer.reach / outer.radius : 1;
    const double share = concentric + (1 - concentric) * offset_shares(size, reach);
    product *= share;
    least = std::min(least, share);
  }
  return std::sqrt(product * least);
}

}  // namespace detp::model
