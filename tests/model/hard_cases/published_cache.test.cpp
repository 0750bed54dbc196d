#include <cmath>
#include <limits>

#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "run.hpp"

using namespace detp;
using namespace detp::hard_cases;
using support::power;

namespace {

/// Σ_{i=1..k} min(n_P, Q^{-3i}), Σ_{i=1..k} min(n_P, Q^{-3i}) Q^{2i-2}, and Q^k.
struct Sums {
  Exact rebuilds;
  Exact tests_per_ray;
  Exact innermost;
};

/// Computes the sums in closed form. Each has two parts: up to the last j with Q^{-3j} <= n_P, and beyond it. j is
/// estimated and then corrected.
Sums closed_sums(double samples, double ratio, std::int64_t k) {
  const Exact q = ratio;
  const auto sparse = [&](const Exact& radius) { return radius * radius * radius * samples >= 1; };
  auto j = static_cast<std::int64_t>(std::min(std::log(samples) / (-3 * std::log(ratio)), static_cast<double>(k)));
  Exact at_j = power(q, j);
  for (; !sparse(at_j); --j) at_j /= q;
  for (; j < k && sparse(at_j * q); ++j) at_j *= q;
  const Exact from_j_to_k = power(q, k - j);
  return {.rebuilds = (1 / (at_j * at_j * at_j) - 1) / (1 - q * q * q) + Exact{samples} * (k - j),
          .tests_per_ray = (1 / at_j - 1) / (q * q * (1 - q)) +
                           samples * at_j * at_j * (1 - from_j_to_k * from_j_to_k) / (1 - q * q),
          .innermost = at_j * from_j_to_k};
}

Sums sums_term_by_term(double samples, double ratio, std::int64_t k) {
  const Exact q = ratio;
  Sums sums{0, 0, 1};
  for (std::int64_t i = 1; i <= k; ++i) {
    const Exact m = std::min<Exact>(samples, power(1 / (q * q * q), i));
    sums.rebuilds += m;
    sums.tests_per_ray += m * sums.innermost * sums.innermost;
    sums.innermost *= q;
  }
  return sums;
}

struct CacheCase {
  Workload workload;
  double ratio;
  std::int64_t i;
  std::int64_t k;
  double time;
};

void compare(const CacheCase& c, Ledger& ledger) {
  using namespace model;
  const auto& [w, ratio, i, k, time] = c;
  const auto inputs = [&c = c] {
    return fmt::format("Q {:a}, i {}, k {}, n_R {:g}, n_P {:g}, t or u {:a}", c.ratio, c.i, c.k, c.workload.rays,
                       c.workload.samples, c.time);
  };
  const Exact q = ratio;
  const Exact before = power(q, i - 1);
  const Exact radius = before * q;
  ledger.compare("n_i, published", published::rays_in_sphere(w.rays, {ratio}, i), w.rays * radius * radius, inputs);
  ledger.compare("m_i, published", published::rebuilds({ratio}, i), 1 / (radius * radius * radius), inputs);
  ledger.compare("t_i, published", published::rebuild_cost(w.rays, {ratio}, i, time), time * (w.rays * before * before),
                 inputs);

  const Sums sums = closed_sums(w.samples, ratio, k);
  const Exact disc_tests = Exact{w.rays} * w.samples * sums.innermost * sums.innermost;
  ledger.compare("T_R, published", published::rebuild_time(w, {ratio}, k, time), time * w.rays * sums.tests_per_ray,
                 inputs);
  ledger.compare("T_I, published", published::intersect_time(w, {ratio}, k, time), time * disc_tests, inputs);
  const Counts<double> counts = published::counts(w, {ratio}, k);
  ledger.compare("sphere tests, published", counts.cull_tests, w.rays * sums.tests_per_ray, inputs);
  ledger.compare("disc tests, published", counts.disc_tests, disc_tests, inputs);
  ledger.compare("rebuilds, published", counts.culls, sums.rebuilds, inputs);
  ledger.compare("T_R for few samples, published", published::rebuild_time_few_samples(w, {ratio}, time),
                 Exact{time} * w.rays * (support::cube_root(w.samples) - 1) / (q * q * (1 - q)), inputs);
  ledger.compare("T unsorted, published", published::unsorted_time(w, time), Exact{time} * w.rays * w.samples, inputs);
}

void compare_random_caches(Draw& draw, Ledger& ledger) {
  const double ratio = draw.ratio();
  compare({.workload = draw.workload(),
           .ratio = ratio,
           .i = draw.index(ratio),
           .k = draw.index(ratio),
           .time = draw.factor()},
          ledger);
}

void compare_edge_caches(Ledger& ledger) {
  constexpr double largest = std::numeric_limits<double>::max();
  std::vector<double> ratios{std::numeric_limits<double>::denorm_min(), 0.65, 2.0 / 3, std::nextafter(1.0 / 3, 1)};
  for (const int n : {1, 2, 3, 10, 20, 30, 40, 50, 52, 53}) {
    ratios.push_back(1 - std::ldexp(1.0, -n));
    ratios.push_back(std::nextafter(1 - std::ldexp(1.0, -n), 0.0));
  }
  for (const int n : {2, 20, 60, 500, 1021, 1022, 1023, 1074}) ratios.push_back(std::ldexp(1.0, -n));
  Workload w{.disc_radius = 0.01, .sphere_radius = 1, .box = {1, 1, 1}};
  for (const double ratio : ratios)
    for (const std::int64_t k : {1LL, 2LL, 20LL, 1LL << 53, 1'000'000'000'000'000'000LL, 9'000'000'000'000'000'000LL})
      for (const double samples : {1.0, 2.0, 8.0, 262144.0, 1e18}) {  // 8, 262144: exactly Q^{-3i} for Q = 1/2
        w.samples = samples;
        w.rays = samples == 8 ? 1 : 1e18;
        compare({w, ratio, k, k, samples == 1 ? largest : samples == 2 ? 5e-324 : 1}, ledger);
      }
  compare({w, 0.5, 1, 0, 0}, ledger);
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("the geometric sums of the reference are the paper's sums, term by term") {
    for (std::uint64_t index = 0; index < 60; ++index) {
      Draw draw(20, index);
      const double ratio = std::max(draw.ratio(), 1e-30);
      const double samples = draw.rays_or_samples();
      const std::int64_t k = draw.whole(1, 120);
      const Sums closed = closed_sums(samples, ratio, k);
      const Sums added = sums_term_by_term(samples, ratio, k);
      REQUIRE(abs(closed.rebuilds / added.rebuilds - 1) < 1e-70);
      REQUIRE(abs(closed.innermost / added.innermost - 1) < 1e-70);
      REQUIRE(abs(closed.tests_per_ray / added.tests_per_ray - 1) < 1e-70);
    }
  }
}

TEST_SUITE("reference value") {
  TEST_CASE("hard cases of the published cache: Q next to 0 and 1, k up to 9e18, powers that under- and overflow") {
    Ledger ledger = on_random_inputs(2, few, compare_random_caches);
    compare_edge_caches(ledger);
    require_right(ledger);
  }
}

TEST_SUITE("hard-cases") {
  TEST_CASE("published cache") { require_right_and_print(on_random_inputs(2, many, compare_random_caches)); }
}
