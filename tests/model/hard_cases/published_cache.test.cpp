#include <algorithm>
#include <cmath>
#include <limits>

#include "detp/model/disc_index/disc_index_published.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "run.hpp"

using namespace detp;
using namespace detp::hard_cases;
using support::power;

namespace published = detp::model::published;

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
  ledger.compare("n_i, published", published::rays_in_sphere(w.rays, {ratio}, i), w.rays * radius * radius, inputs,
                 1e-15);
  ledger.compare("m_i, published", published::rebuilds({ratio}, i), 1 / (radius * radius * radius), inputs, 1e-15);
  ledger.compare("t_i, published", published::rebuild_cost(w.rays, {ratio}, i, time), time * (w.rays * before * before),
                 inputs, 1e-15);

  const Sums sums = closed_sums(w.samples, ratio, k);
  const Exact disc_tests = Exact{w.rays} * w.samples * sums.innermost * sums.innermost;
  ledger.compare("T_R, published", published::rebuild_time(w, {ratio}, k, time), time * w.rays * sums.tests_per_ray,
                 inputs, 1e-15);
  ledger.compare("T_I, published", published::intersect_time(w, {ratio}, k, time), time * disc_tests, inputs, 1e-15);
  const Counts<double> counts = published::counts(w, {ratio}, k);
  ledger.compare("sphere tests, published", counts.cull_tests, w.rays * sums.tests_per_ray, inputs, 1e-15);
  ledger.compare("disc tests, published", counts.disc_tests, disc_tests, inputs, 1e-15);
  ledger.compare("rebuilds, published", counts.culls, sums.rebuilds, inputs, 1e-15);
  ledger.compare("T_R for few samples, published", published::rebuild_time_few_samples(w, {ratio}, time),
                 Exact{time} * w.rays * (support::cube_root(w.samples) - 1) / (q * q * (1 - q)), inputs, 1e-15);
  ledger.compare("T unsorted, published", published::unsorted_time(w, time), Exact{time} * w.rays * w.samples, inputs,
                 1e-15);
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

/// Compares the depth with the largest k >= 0 for which 2^{k+1} d <= s; 0 if there is none.
void compare_depth(double d, double side, Ledger& ledger) {
  const int depth = published::octree_depth({d}, side);
  const bool narrow_enough = depth == 0 || ldexp(Exact{d}, depth + 1) <= side;
  ledger.compare_whole("octree depth, published", depth, narrow_enough && ldexp(Exact{d}, depth + 2) > side,
                       [&] { return fmt::format("d {:a}, s {:a}", d, side); });
}

void compare_depths_around(double d, double side, Ledger& ledger) {
  for (const double disc : {std::nextafter(d, 0.0), d, std::nextafter(d, 1e308)})
    if (disc > 0 && std::isfinite(disc)) compare_depth(disc, side, ledger);
}

void compare_costs(const Workload& w, int depth, double disc_test, Ledger& ledger) {
  const auto inputs = [&] {
    return fmt::format("depth {}, n_R {:g}, n_P {:g}, u {:a}", depth, w.rays, w.samples, disc_test);
  };
  const Exact tests = ldexp(Exact{w.samples}, -2 * depth);
  const Exact time = disc_test * (w.rays * tests);
  ledger.compare("cells of a line, published", published::cells_per_line(depth), ldexp(Exact{1}, depth), inputs, 1e-15);
  ledger.compare("discs in a cell, published", published::discs_per_cell(w.samples, depth),
                 ldexp(Exact{w.samples}, -3 * depth), inputs, 1e-15);
  ledger.compare("tests of a line, published", published::tests_per_line(w.samples, depth), tests, inputs, 1e-15);
  ledger.compare("T of an octree, published", published::octree_time(w, depth, disc_test), depth * time, inputs, 1e-15);
  ledger.compare("T balanced, published", published::balanced_octree_time(w, depth, disc_test), time, inputs, 1e-15);
}

void compare_random_octrees(Draw& draw, Ledger& ledger) {
  const double side = draw.anywhere();
  compare_depth(draw.log_uniform(5e-324, side), side, ledger);
  compare_depths_around(std::ldexp(side, -static_cast<int>(draw.whole(0, 1000))), side, ledger);
  compare_costs(draw.workload(), static_cast<int>(draw.count(1, 2097)) - 1, draw.factor(), ledger);
}

void compare_edge_octrees(Ledger& ledger) {
  for (const double side : {5e-324, 0x1p-1022, 1e-300, 1.0, 2.0, 0x1.fffffffffffffp+0, 1.79e308})
    for (int n = -3; n <= 2100; n += n < 70 ? 1 : 37) compare_depths_around(std::ldexp(side, -n), side, ledger);
  Workload w{.disc_radius = 1, .sphere_radius = 1, .box = {1, 1, 1}};
  for (const int depth : {0, 1, 30, 340, 500, 1023, 1024, 2096})
    for (const double count : {1.0, 1e18})
      for (const double disc_test : {0.0, 5e-324, 1e-9, 1.79e308}) {
        w.rays = w.samples = count;
        compare_costs(w, depth, disc_test, ledger);
      }
}

/// (2/D)^{1/(D-2)}.
Exact exact_optimum(double dimension) {
  const Exact beyond = Exact{dimension} - 2;
  return support::exp_of(beyond == 0 ? Exact{-1} / 2 : Exact{support::log_of(2 / Exact{dimension}) / beyond});
}

void compare_dimension(double dimension, Ledger& ledger) {
  ledger.compare(
      "Q*", model::optimal_ratio(dimension), exact_optimum(dimension), [&] { return fmt::format("D {:a}", dimension); },
      1e-15);
}

void compare_random_ratios(Draw& draw, Ledger& ledger) {
  const double gap = draw.log_uniform(1e-17, 1);
  const double side = draw.whole(0, 1) == 0 ? -1 : 1;
  const std::int64_t kind = draw.whole(0, 3);
  const double dimension = kind == 0 ? draw.uniform(1, 3) : kind == 1 ? 2 + side * gap : kind == 2 ? 3 - gap : 1 + gap;
  compare_dimension(std::clamp(dimension, 1.0, 3.0), ledger);
}

void compare_edge_ratios(Ledger& ledger) {
  for (const double dimension : {1.0, std::nextafter(1.0, 2.0), std::nextafter(2.0, 1.0), 2.0, std::nextafter(2.0, 3.0),
                                 std::nextafter(3.0, 2.0), 3.0})
    compare_dimension(dimension, ledger);
  for (double gap = 1e-17; gap < 2e-3; gap *= 10)
    for (const double dimension : {1 + gap, 2 - gap, 2 + gap, 3 - gap}) compare_dimension(dimension, ledger);
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

  TEST_CASE("hard cases of the published octree: powers of two and their neighbours, all possible depths") {
    Ledger ledger = on_random_inputs(8, few, compare_random_octrees);
    compare_edge_octrees(ledger);
    require_right(ledger);
  }

  TEST_CASE("hard cases of Q*: D next to 1, 2 and 3") {
    Ledger ledger = on_random_inputs(3, few, compare_random_ratios);
    compare_edge_ratios(ledger);
    require_right(ledger);
  }
}

TEST_SUITE("hard-cases") {
  TEST_CASE("published cache") { require_right_and_print(on_random_inputs(2, many, compare_random_caches)); }

  TEST_CASE("published octree") { require_right_and_print(on_random_inputs(8, many, compare_random_octrees)); }

  TEST_CASE("Q*") { require_right_and_print(on_random_inputs(3, many, compare_random_ratios)); }
}
