#include "sphere_cache.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "detp/model/lines/line_measure.hpp"
#include "listed_rays.hpp"
#include "rebuild_law.hpp"
#include "sample_spread.hpp"
#include "sphere_count.hpp"

namespace detp::model {
namespace {

constexpr std::size_t remembered = 6;
constexpr std::int64_t most_groups = 4096;  // number of groups of full size

/// Walks through the spheres from the outside in.
class Walk {
 public:
  Walk(const Valid<Workload>& workload, const Valid<SphereCacheParameters>& parameters)
      : workload_(workload), parameters_(parameters) {
    require_rebuild_law(parameters.order);
    log_ratio_ = std::log(parameters.ratio);
    current_ = {
        .radius = workload.sphere_radius, .rays = workload.rays, .listed = workload.rays, .served = workload.rays};
  }

  /// Moves to sphere i, which is `step` spheres inside the current one.
  const SphereLevel& to(std::int64_t i, std::int64_t step) {
    const SphereLevel outer = current_;
    const auto spheres = static_cast<double>(step);
    const double r = workload_.sphere_radius * std::pow(parameters_.ratio, static_cast<double>(i));
    current_ = {.i = i, .radius = r, .rays = rays_through(workload_, r)};
    current_.rebuilds = rebuilds(outer, spheres);
    current_.listed = std::min(outer.listed, current_.rays * share_listed(outer));
    current_.tests = tests(outer, spheres);
    current_.served = longer(current_, 0.25 * (1 - std::min(1.0, current_.rebuilds / workload_.samples)));
    return current_;
  }

  [[nodiscard]] const SphereLevel& innermost() const { return current_; }

 private:
  /// m_i of the sphere that is `step` spheres inside `outer`. At each of these spheres n - m shrinks by the same
  /// factor, which is computed for the middle one.
  [[nodiscard]] double rebuilds(const SphereLevel& outer, double step) const {
    const double n = workload_.samples;
    const double d = workload_.disc_radius;
    if (current_.radius <= d) return n;
    const double middle = step == 1 ? current_.radius : current_.radius * std::exp(-0.5 * (step - 1) * log_ratio_);
    if (parameters_.order == SampleOrder::none)
      return std::max(outer.rebuilds, single_rebuilds(workload_, middle - d, SampleOrder::none));
    const Ball ball = ball_of(workload_, middle - d);
    const double alone = single_rebuilds(workload_.dimension, n, ball);
    // ρ_{i-1}/ρ_i - 1, without cancellation as Q → 1
    const double apart = std::min(1e300, -std::expm1(log_ratio_) / parameters_.ratio * (middle / (middle - d)));
    const double own =
        own_rebuild_share(workload_.dimension, ball, std::log1p(apart) / std::numbers::ln2, outer.rebuilds / alone);
    if (outer.i == 0 && step == 1) return alone;
    if (step == 1) return nested_rebuilds(alone, outer.rebuilds, own, n);
    const double shrinking = std::exp(step * std::log1p(-std::min(1.0, alone / n * own)));
    return std::max(alone, n - (n - outer.rebuilds) * shrinking);
  }

  /// L'_{i-1} for the sphere S_i that is `step` spheres inside `outer`. S_{i-1} lies between the two, and so does the
  /// length of its list.
  [[nodiscard]] double tests(const SphereLevel& outer, double step) const {
    const double more = outer.rebuilds / current_.rebuilds;
    const double again = step == 1 ? more : std::pow(more, 1 / step);
    const double lengthening = 0.6 * again * (1 - again);
    if (step == 1) return longer(outer, lengthening);
    if (!(current_.listed > 0)) return 0;
    SphereLevel around = current_;
    around.listed *= std::pow(outer.listed / current_.listed, 1 / step);
    around.rays = around.listed / std::min(1.0, current_.listed / current_.rays);
    return longer(around, lengthening);
  }

  /// A list's length, averaged over its uses instead of over its builds.
  [[nodiscard]] double longer(const SphereLevel& sphere, double lengthening) const {
    if (sphere.i == 0 || parameters_.order == SampleOrder::none || !(sphere.rays > 0)) return sphere.listed;
    return sphere.listed * (1 + lengthening * (1 - sphere.listed / sphere.rays));
  }

  double share_listed(const SphereLevel& outer) {
    if (parameters_.order != SampleOrder::none)
      return listed_share(workload_, current_.radius, -log_ratio_ / std::numbers::ln2);
    const bool outermost = outer.i == 0;
    around_.insert(around_.begin(), {outer.radius, outer.rebuilds,
                                     outermost ? std::sqrt(2 * mean_square_distance(workload_))
                                               : std::max(0.0, outer.radius - workload_.disc_radius)});
    if (around_.size() > remembered) around_.pop_back();
    return unsorted_listed_share(current_.radius, current_.rebuilds, around_);
  }

  const Valid<Workload>& workload_;
  SphereCacheParameters parameters_;
  double log_ratio_ = 0;
  SphereLevel current_;
  std::vector<EnclosingSphere> around_;  ///< the nearest first; for unsorted samples
};

/// Sum of `terms` terms of a geometric sequence: b is the last term, and a is the term before the first. If b is too
/// small for a double, `log_ratio` is the logarithm of the ratio.
double sum_of_terms(double a, double b, double terms, double log_ratio) {
  if (terms == 1) return b;
  if (!(a > 0)) return terms * b / 2;
  if (b > 0) log_ratio = (std::log(b) - std::log(a)) / terms;
  if (std::abs(log_ratio) < 1e-14) return terms * b;
  return log_ratio < 0 ? a * std::exp(log_ratio) * (std::expm1(terms * log_ratio) / std::expm1(log_ratio))
                       : b * (std::expm1(-terms * log_ratio) / std::expm1(-log_ratio));
}

/// The number of the k spheres with r_i >= d. If k is small, all k: they need no groups.
std::int64_t spheres_that_hold(const Valid<Workload>& workload, const SphereCacheParameters& parameters) {
  if (parameters.spheres <= most_groups) return parameters.spheres;
  if (workload.disc_radius >= workload.sphere_radius) return 0;
  return std::min(parameters.spheres,
                  sphere_count(Form::corrected, {parameters.ratio}, {workload.disc_radius}, {workload.sphere_radius}));
}

}  // namespace

std::vector<SphereLevel> sphere_levels(const Valid<Workload>& workload, const Valid<SphereCacheParameters>& parameters,
                                       std::int64_t most) {
  Walk walk(workload, parameters);
  std::vector<SphereLevel> levels;
  for (std::int64_t i = 1; i <= std::min(most, parameters.spheres); ++i) levels.push_back(walk.to(i, 1));
  return levels;
}

void for_each_level(const Valid<Workload>& workload, const Valid<SphereCacheParameters>& parameters,
                    const std::function<bool(const SphereLevel&)>& visit) {
  Walk walk(workload, parameters);
  for (std::int64_t i = 1; i <= parameters.spheres; ++i)
    if (!visit(walk.to(i, 1))) return;
}

Counts<double> sphere_cache_counts(const Valid<Workload>& workload, const Valid<SphereCacheParameters>& parameters) {
  Walk walk(workload, parameters);
  Counts<double> counts{.visits = workload.samples,
                        .sorted = parameters.order == SampleOrder::none ? 0 : workload.samples,
                        .hits = expected_hits(workload)};
  const double vanishing = 2 * std::log(parameters.ratio);  // lists of very small spheres are proportional to r_i²
  double tests = 0;
  double copies = 0;
  double rebuilds = 0;
  // Adds groups of `largest` spheres each, but smaller groups towards `to`, where r_i - d goes to 0.
  const auto add_groups = [&](std::int64_t from, std::int64_t to) {
    const std::int64_t largest = (to - from - 1) / most_groups + 1;
    for (std::int64_t i = from; i < to;) {
      const std::int64_t step = std::clamp<std::int64_t>((to - i) / 16, 1, largest);
      const auto spheres = static_cast<double>(step);
      const SphereLevel& sphere = walk.to(i += step, step);
      const double added_tests = sphere.rebuilds * sphere.tests;
      const double added_copies = sphere.rebuilds * sphere.listed;
      counts.cull_tests += sum_of_terms(tests, added_tests, spheres, vanishing);
      counts.culls += sum_of_terms(rebuilds, sphere.rebuilds, spheres, vanishing);
      counts.listed += sum_of_terms(copies, added_copies, spheres, vanishing);
      tests = added_tests;
      copies = added_copies;
      rebuilds = sphere.rebuilds;
    }
  };
  const std::int64_t k = parameters.spheres;
  const std::int64_t holding = spheres_that_hold(workload, parameters);
  add_groups(0, holding);
  add_groups(holding, k);
  counts.disc_tests = workload.samples * walk.innermost().served;
  return counts;
}

}  // namespace detp::model
