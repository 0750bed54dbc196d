#include "detp/model/sphere_cache/sphere_cache_published.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "detp/model/lines/line_measure.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"
#include "support/high_precision.hpp"
#include "support/not_a_length.hpp"
#include "support/random_workload.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Contains;
using support::Exact;
using support::relative_error;

namespace {

/// The largest relative error of one quantity so far.
struct Worst {
  double error = 0;
  void compare(double value, const Exact& exact) { error = std::max(error, relative_error(value, exact)); }
};

/// The sums of the paper, term by term.
struct Sums {
  Exact rebuilds = 0;      ///< Σ min(n_P, m_i)
  Exact rebuild_time = 0;  ///< eq 12
  Exact rays = 0;          ///< n_k
};

Sums add_up(const Workload& w, double ratio, std::int64_t k, double sphere_test) {
  const Exact q = ratio;
  const Exact samples = w.samples;
  Sums sums;
  Exact n = w.rays;  // n_{i-1}
  Exact cells = 1;   // 1/m_{i-1}
  for (std::int64_t i = 1; i <= k; ++i) {
    cells *= q * q * q;
    const Exact m = cells * samples <= 1 ? samples : Exact{1 / cells};
    sums.rebuilds += m;
    sums.rebuild_time += m * n * sphere_test;
    n *= q * q;
  }
  sums.rays = n;
  return sums;
}

const Workload some = {.rays = 1000, .samples = 100, .disc_radius = 0.01, .sphere_radius = 1, .box = {1, 1, 1}};

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("the closed forms are the paper's sums within 1e-14, on 5000 random workloads") {
    support::RandomNumbers random(20060101);
    Worst n;
    Worst m;
    Worst t;
    Worst rebuild;
    Worst intersect;
    Worst total;
    Worst rebuilds;
    Worst few;
    for (int run = 0; run < 5000; ++run) {
      const auto [w, ratio] = support::random_workload(random);
      const double sphere_test = random.log_uniform(1e-9, 1e3);
      const double disc_test = random.log_uniform(1e-9, 1e3);
      const std::int64_t k = sphere_count(random.whole(0, 1) == 0 ? Form::published : Form::corrected, {ratio},
                                          {w.disc_radius}, {w.sphere_radius});
      const Exact q = ratio;
      const std::int64_t i = random.whole(1, std::max<std::int64_t>(1, k));
      const Exact shrunk = support::power(q, i - 1);
      const Exact outer_rays = w.rays * shrunk * shrunk;
      n.compare(published::rays_in_sphere(w.rays, {ratio}, i), outer_rays * q * q);
      m.compare(published::rebuilds({ratio}, i), 1 / (shrunk * shrunk * shrunk * q * q * q));
      t.compare(published::rebuild_cost(w.rays, {ratio}, i, sphere_test), outer_rays * sphere_test);

      const Sums sums = add_up(w, ratio, k, sphere_test);
      const Exact intersecting = sums.rays * w.samples * disc_test;
      const double t_rebuild = published::rebuild_time(w, {ratio}, k, sphere_test);
      const double t_intersect = published::intersect_time(w, {ratio}, k, disc_test);
      rebuild.compare(t_rebuild, sums.rebuild_time);
      intersect.compare(t_intersect, intersecting);
      total.compare(t_rebuild + t_intersect, sums.rebuild_time + intersecting);
      rebuilds.compare(published::counts(w, {ratio}, k).culls, sums.rebuilds);
      const Exact root = support::cube_root(w.samples);
      few.compare(published::rebuild_time_few_samples(w, {ratio}, sphere_test),
                  sphere_test * w.rays * (root - 1) / (q * q * (1 - q)));
    }
    CAPTURE(n.error);
    CAPTURE(m.error);
    CAPTURE(t.error);
    CAPTURE(rebuild.error);
    CAPTURE(intersect.error);
    CAPTURE(total.error);
    CAPTURE(rebuilds.error);
    CAPTURE(few.error);
    for (const double error :
         {n.error, m.error, t.error, rebuild.error, intersect.error, total.error, rebuilds.error, few.error})
      CHECK(error < 1e-14);  // largest error seen: 4e-16
  }

  TEST_CASE("Q next to 1 loses no digits") {
    for (const double gap : {0x1p-10, 0x1p-14, 0x1.8p-17}) {
      Workload w = some;
      w.samples = 7;
      const std::int64_t k = 20'000;
      const Sums sums = add_up(w, 1 - gap, k, 1);
      CHECK(relative_error(published::rebuild_time(w, {1 - gap}, k, 1), sums.rebuild_time) < 1e-14);
      CHECK(relative_error(published::intersect_time(w, {1 - gap}, k, 1), sums.rays * 7) < 1e-14);
      CHECK(relative_error(published::counts(w, {1 - gap}, k).culls, sums.rebuilds) < 1e-14);
    }
  }

  TEST_CASE("many spheres: Qᵏ with k up to 1e12 keeps its digits") {
    const double q = 1 - 0x1p-37;
    for (const std::int64_t k : {1'000'000'000LL, 137'438'953'472LL, 1'000'000'000'000LL}) {
      const Exact shrunk = support::power(q, k);
      CHECK(relative_error(published::rays_in_sphere(1e9, {q}, k), 1e9 * shrunk * shrunk) < 1e-14);
      CHECK(relative_error(published::rebuilds({q}, k), 1 / (shrunk * shrunk * shrunk)) < 1e-14);
    }
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("half the radius has a quarter of the rays and eight times the rebuilds") {
    CHECK(published::rays_in_sphere(1024, {0.5}, 3) == doctest::Approx(16).epsilon(1e-15));
    CHECK(published::rebuilds({0.5}, 3) == doctest::Approx(512).epsilon(1e-15));
    CHECK(published::rebuild_cost(1024, {0.5}, 3, 2) == doctest::Approx(128).epsilon(1e-15));
    // 8·1000 + 64·250 + 100·62.5
    CHECK(published::rebuild_time(some, {0.5}, 3, 1) == doctest::Approx(30250).epsilon(1e-14));
    CHECK(published::counts(some, {0.5}, 3).culls == doctest::Approx(172).epsilon(1e-14));
  }

  TEST_CASE("without spheres, or without sorting, every disc meets every ray") {
    CHECK(published::rebuild_time(some, {0.5}, 0, 1) == 0);
    CHECK(published::intersect_time(some, {0.5}, 0, 3) == doctest::Approx(3e5).epsilon(1e-15));
    CHECK(published::unsorted_time(some, 3) == 3e5);
  }

  TEST_CASE("one sample needs each sphere once, and the form for few samples then gives no time") {
    Workload w = some;
    w.samples = 1;
    CHECK(published::counts(w, {0.5}, 20).culls == 20);
    CHECK(published::rebuild_time_few_samples(w, {0.5}, 1) == 0);
  }

  TEST_CASE("rebuilds saturate at the largest double, and rays tend to zero") {
    CHECK(published::rebuilds({0.5}, 1'000'000) == std::numeric_limits<double>::max());
    CHECK(published::rays_in_sphere(1e18, {0.5}, 1'000'000) == 0);
    CHECK(std::isfinite(published::rebuild_time(some, {0.01}, 4'000'000'000'000'000'000, 1)));
  }
}

TEST_SUITE("identity") {
  TEST_CASE("the times follow from the counts") {
    support::RandomNumbers random(5);
    for (int run = 0; run < 200; ++run) {
      const auto [w, ratio] = support::random_workload(random);
      const std::int64_t k = random.whole(1, 50);
      const Counts<double> counts = published::counts(w, {ratio}, k);
      CHECK(counts.cull_tests == published::rebuild_time(w, {ratio}, k, 1));
      CHECK(counts.disc_tests == published::intersect_time(w, {ratio}, k, 1));
      CHECK(counts.sorted == w.samples);
      CHECK(counts.hits == expected_hits(w));
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a ratio, an index or a number of rays out of range is refused by name") {
    for (const double bad : support::not_a_ratio) {
      const Contains name("radius ratio Q");
      CHECK_THROWS_WITH_AS((void)published::rays_in_sphere(1, {bad}, 1), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::rebuilds({bad}, 1), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::rebuild_cost(1, {bad}, 1, 1), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::rebuild_time(some, {bad}, 1, 1), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::rebuild_time_few_samples(some, {bad}, 1), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::intersect_time(some, {bad}, 1, 1), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::counts(some, {bad}, 1), name, std::invalid_argument);
    }
    const Contains index("index of the sphere");
    CHECK_THROWS_WITH_AS((void)published::rays_in_sphere(1, {0.5}, -1), index, std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)published::rebuilds({0.5}, -1), index, std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)published::rebuild_cost(1, {0.5}, 0, 1), index, std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)published::rebuild_time(some, {0.5}, -1, 1), index, std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)published::intersect_time(some, {0.5}, -1, 1), index, std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)published::counts(some, {0.5}, -1), index, std::invalid_argument);
    for (const double bad : support::not_a_length)
      CHECK_THROWS_WITH_AS((void)published::rays_in_sphere(bad, {0.5}, 1), Contains("number of rays"),
                           std::invalid_argument);
  }

  TEST_CASE("a workload out of range is refused by name") {
    for (const double bad : support::not_a_count) {
      Workload w = some;
      w.samples = bad;
      const Contains name("number of samples");
      CHECK_THROWS_WITH_AS((void)published::rebuild_time(w, {0.5}, 1, 1), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::rebuild_time_few_samples(w, {0.5}, 1), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::intersect_time(w, {0.5}, 1, 1), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::counts(w, {0.5}, 1), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::unsorted_time(w, 1), name, std::invalid_argument);
    }
  }

  TEST_CASE("an invalid time of a test is refused by name") {
    for (const double bad : support::not_a_size) {
      const Contains sphere("time of a ray-sphere test");
      const Contains disc("time of a ray-disc test");
      CHECK_THROWS_WITH_AS((void)published::rebuild_cost(1, {0.5}, 1, bad), sphere, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::rebuild_time(some, {0.5}, 1, bad), sphere, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::rebuild_time_few_samples(some, {0.5}, bad), sphere, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::intersect_time(some, {0.5}, 1, bad), disc, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::unsorted_time(some, bad), disc, std::invalid_argument);
    }
  }
}
