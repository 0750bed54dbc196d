#include "sphere_cache_published.hpp"

#include <algorithm>
#include <cmath>

#include "detp/model/lines/line_measure.hpp"

namespace detp::model::published {
namespace {

void check_arguments(RadiusRatio ratio, std::int64_t i) {
  require_ratio("radius ratio Q", ratio.value);
  require_count("index of the sphere", static_cast<double>(i), 0, 9e18);
}

/// Qⁿ in long double, so that a large exponent loses no digits.
long double power(RadiusRatio ratio, long double exponent) {
  return std::exp(exponent * std::log(static_cast<long double>(ratio.value)));
}

/// Σ_{i=0}^{n-1} xⁱ for x = e^{log_x}.
long double geometric_sum(long double log_x, long double n) { return std::expm1(n * log_x) / std::expm1(log_x); }

/// The number of spheres, from the outside in, with m_i = Q^{-3i} <= n_P.
long double sparse_spheres(double samples, RadiusRatio ratio, std::int64_t k) {
  const long double most =
      std::log(static_cast<long double>(samples)) / (-3 * std::log(static_cast<long double>(ratio.value)));
  return std::min(static_cast<long double>(k), std::floor(most));
}

}  // namespace

double rays_in_sphere(double rays, RadiusRatio ratio, std::int64_t i) {
  require_positive("number of rays", rays);
  check_arguments(ratio, i);
  return saturated(rays * power(ratio, 2.0L * i));
}

double rebuilds(RadiusRatio ratio, std::int64_t i) {
  check_arguments(ratio, i);
  return saturated(power(ratio, -3.0L * i));
}

double rebuild_cost(double rays, RadiusRatio ratio, std::int64_t i, double sphere_test) {
  require_non_negative("time of a ray-sphere test", sphere_test);
  require_count("index of the sphere", static_cast<double>(i), 1, 9e18);
  require_positive("number of rays", rays);
  check_arguments(ratio, i);
  return saturated(sphere_test * (rays * power(ratio, 2.0L * (i - 1))));
}

double rebuild_time(const Valid<Workload>& workload, RadiusRatio ratio, std::int64_t k, double sphere_test) {
  require_non_negative("time of a ray-sphere test", sphere_test);
  check_arguments(ratio, k);
  const long double log_q = std::log(static_cast<long double>(ratio.value));
  const long double sparse = sparse_spheres(workload.samples, ratio, k);
  // T_R/(t n_R) has two parts. `before`, over the first j = `sparse` spheres: Σ_{i=1..j} Q^{-3i} Q^{2i-2} =
  // Q^{-3} Σ_{i=0..j-1} Q^{-i}. `after`, over the others: n_P Σ_{i=j+1..k} Q^{2i-2}.
  const long double before = sparse > 0 ? std::exp(-3 * log_q) * geometric_sum(-log_q, sparse) : 0;
  const long double after = workload.samples * std::exp(2 * sparse * log_q) * geometric_sum(2 * log_q, k - sparse);
  return saturated(sphere_test * (workload.rays * (before + after)));
}

double rebuild_time_few_samples(const Valid<Workload>& workload, RadiusRatio ratio, double sphere_test) {
  require_non_negative("time of a ray-sphere test", sphere_test);
  require_ratio("radius ratio Q", ratio.value);
  const long double q = ratio.value;
  const long double root_less_1 = std::expm1(std::log(static_cast<long double>(workload.samples)) / 3);
  return saturated(sphere_test * (workload.rays * root_less_1) / (q * q * (1 - q)));
}

double intersect_time(const Valid<Workload>& workload, RadiusRatio ratio, std::int64_t k, double disc_test) {
  require_non_negative("time of a ray-disc test", disc_test);
  check_arguments(ratio, k);
  return saturated(disc_test * (workload.rays * power(ratio, 2.0L * k)) * workload.samples);
}

Counts<double> counts(const Valid<Workload>& workload, RadiusRatio ratio, std::int64_t k) {
  check_arguments(ratio, k);
  const long double log_q = std::log(static_cast<long double>(ratio.value));
  const long double sparse = sparse_spheres(workload.samples, ratio, k);
  const long double rare = sparse > 0 ? std::exp(-3 * log_q) * geometric_sum(-3 * log_q, sparse) : 0;
  return {.cull_tests = rebuild_time(workload, ratio, k, 1),
          .culls = static_cast<double>(rare + workload.samples * (k - sparse)),
          .visits = workload.samples,
          .disc_tests = intersect_time(workload, ratio, k, 1),
          .sorted = workload.samples,
          .hits = expected_hits(workload)};
}

double unsorted_time(const Valid<Workload>& workload, double disc_test) {
  require_non_negative("time of a ray-disc test", disc_test);
  return saturated(static_cast<long double>(disc_test) * workload.rays * workload.samples);
}

}  // namespace detp::model::published
