#include "sphere_cache.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "line_measure.hpp"
#include "rebuild_law.hpp"

namespace detp::model {
namespace {

constexpr std::size_t ancestors = 6;
constexpr std::int64_t most_groups = 4096;

/// H on a grid of (size of the inner sphere, reach of the offset), both relative to the outer sphere, in [0, 1].
class OffsetShares {
 public:
  OffsetShares() {
    for (int i = 0; i <= sizes; ++i)
      for (int j = 0; j <= reaches; ++j)
        entry(i, j) = average(static_cast<double>(i) / sizes, static_cast<double>(j) / reaches);
  }

  [[nodiscard]] double operator()(double size, double reach) const {
    const double x = std::clamp(size, 0.0, 1.0) * sizes;
    const double y = std::clamp(reach, 0.0, 1.0) * reaches;
    const int i = std::min(static_cast<int>(x), sizes - 1);
    const int j = std::min(static_cast<int>(y), reaches - 1);
    const double u = x - i;
    const double v = y - j;
    return (1 - u) * ((1 - v) * entry(i, j) + v * entry(i, j + 1)) +
           u * ((1 - v) * entry(i + 1, j) + v * entry(i + 1, j + 1));
  }

 private:
  static constexpr int sizes = 32;
  static constexpr int reaches = 16;

  static double average(double size, double reach) {
    constexpr int offsets = 8;
    double sum = 0;
    for (int i = 0; i < offsets; ++i)
      sum += both_hit_share(1, std::max(size, 1e-6), reach * std::sqrt((i + 0.5) / offsets));
    return sum / offsets;
  }

  double& entry(int i, int j) { return values_[static_cast<std::size_t>(i * (reaches + 1) + j)]; }
  [[nodiscard]] double entry(int i, int j) const { return values_[static_cast<std::size_t>(i * (reaches + 1) + j)]; }

  std::array<double, (sizes + 1) * (reaches + 1)> values_{};
};

/// √2 times the samples' root mean square distance from the centre of S₀: uniform in a box, or on its faces.
double sample_reach(const Workload& workload) {
  double squares = 0;
  for (const double side : workload.box) squares += side * side;
  const double volume = std::clamp(workload.dimension - 2, 0.0, 1.0);
  return std::sqrt(2 * squares * (volume / 12 + (1 - volume) * 5 / 36));
}

/// Goes through the spheres from the outside in, keeping what the next one needs of those around it.
class Walk {
 public:
  Walk(const Workload& workload, const SphereCacheParameters& parameters)
      : workload_(workload), parameters_(parameters) {
    check(workload);
    check(Candidate{Technique::sphere_cache, parameters});
    current_ = {.radius = workload.sphere_radius, .rays = workload.rays, .listed = workload.rays, .rebuilds = 1};
    outwards_.push_back({workload.sphere_radius, 0, sample_reach(workload)});
  }

  /// The sphere i, `step` spheres inside the last one.
  const SphereLevel& to(std::int64_t i, std::int64_t step) {
    using std::numbers::pi;
    const SphereLevel outer = current_;
    if (outer.i > 0) remember(outer);
    const double r = workload_.sphere_radius * std::pow(parameters_.ratio, static_cast<double>(i));
    current_ = {.i = i, .radius = r, .tests = outer.listed};
    current_.rays = workload_.rays * crossing_probability(workload_, 4 * pi / 3 * r * r * r, 4 * pi * r * r);
    const double alone = single_rebuilds(workload_, r - workload_.disc_radius, parameters_.order);
    current_.rebuilds = outer.rebuilds;
    const double chain = chain_to(r, alone);
    for (std::int64_t n = 0; n < std::min<std::int64_t>(step, 64); ++n)
      current_.rebuilds = chained_rebuilds(alone, current_.rebuilds, chain, workload_.samples);
    current_.rebuilds = std::max(current_.rebuilds, outer.rebuilds);
    current_.listed = std::min(outer.listed, current_.rays * listed_share(current_, outwards_));
    return current_;
  }

 private:
  /// The share of the next larger sphere's rebuilds that add to those of the sphere of radius r.
  double chain_to(double r, double alone) const {
    const double ball = r - workload_.disc_radius;
    const double around = r / parameters_.ratio - workload_.disc_radius;
    if (parameters_.order == SampleOrder::none || !(ball > 0 && around > 0)) return 0;
    return chain_share(workload_.dimension, std::min(1.0, ball / around), std::log2(scene_side(workload_) / ball),
                       alone / workload_.samples);
  }

  void remember(const SphereLevel& sphere) {
    outwards_.insert(outwards_.begin(),
                     {sphere.radius, sphere.rebuilds, std::max(0.0, sphere.radius - workload_.disc_radius)});
    if (outwards_.size() > ancestors) outwards_.pop_back();
  }

  const Workload& workload_;
  SphereCacheParameters parameters_;
  SphereLevel current_;
  std::vector<Enclosing> outwards_;
};

}  // namespace

double listed_share(const SphereLevel& sphere, const std::vector<Enclosing>& outwards) {
  require_non_negative("sphere radius", sphere.radius);
  require_positive("rebuilds of the sphere", sphere.rebuilds);
  static const OffsetShares offset_shares;
  double product = 1;
  double least = 1;
  for (const Enclosing& outer : outwards) {
    require_non_negative("sphere radius", outer.radius);
    require_non_negative("rebuilds of the outer sphere", outer.rebuilds);
    const double concentric = std::min(1.0, outer.rebuilds / sphere.rebuilds);
    require_non_negative("reach of the offsets", outer.reach);
    const double size = outer.radius > 0 ? sphere.radius / outer.radius : 1;  // both may be too small for a double
    const double reach = outer.radius > 0 ? std::min(1.0, outer.reach / outer.radius) : 1;
    const double share = concentric + (1 - concentric) * offset_shares(size, reach);
    product *= share;
    least = std::min(least, share);
  }
  return std::sqrt(product * least);
}

std::vector<SphereLevel> sphere_levels(const Workload& workload, const SphereCacheParameters& parameters,
                                       std::int64_t most) {
  Walk walk(workload, parameters);
  std::vector<SphereLevel> levels;
  for (std::int64_t i = 1; i <= std::min(most, parameters.spheres); ++i) levels.push_back(walk.to(i, 1));
  return levels;
}

Counts<double> sphere_cache_counts(const Workload& workload, const SphereCacheParameters& parameters) {
  Walk walk(workload, parameters);
  Counts<double> counts{.sorted = parameters.order == SampleOrder::none ? 0 : workload.samples,
                        .hits = expected_hits(workload)};
  const std::int64_t k = parameters.spheres;
  const std::int64_t groups = std::min(k, most_groups);
  double innermost = workload.rays;
  std::int64_t last = 0;
  for (std::int64_t group = 1; group <= groups; ++group) {
    const std::int64_t i = k / groups * group + k % groups * group / groups;
    const auto spheres = static_cast<double>(i - last);
    const SphereLevel& sphere = walk.to(i, i - last);
    counts.sphere_tests += spheres * sphere.rebuilds * sphere.tests;
    counts.rebuilds += spheres * sphere.rebuilds;
    counts.copies += spheres * sphere.rebuilds * sphere.listed;
    innermost = sphere.listed;
    last = i;
  }
  counts.disc_tests = workload.samples * innermost;
  return counts;
}

}  // namespace detp::model
