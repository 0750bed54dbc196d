#include "detp/model/sphere_cache.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/model/line_measure.hpp"
#include "support/high_precision.hpp"
#include "support/not_a_length.hpp"
#include "support/random_workload.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Approx;
using doctest::Contains;

namespace {

const Workload typical = cube_workload(1e6, 1e5, 0.01, 2);

bool all_finite(const Counts<double>& counts) {
  bool finite = true;
  for_each_term(counts, [&](std::string_view, double term) { finite = finite && std::isfinite(term) && term >= 0; });
  return finite;
}

/// The counts by the sums of the header, over all levels.
Counts<double> summed(const Workload& w, const SphereCacheParameters& parameters) {
  Counts<double> sum;
  double innermost = w.rays;
  for (const SphereLevel& level : sphere_levels(w, parameters, parameters.spheres)) {
    sum.sphere_tests += level.rebuilds * level.tests;
    sum.rebuilds += level.rebuilds;
    sum.copies += level.rebuilds * level.listed;
    innermost = level.listed;
  }
  sum.disc_tests = w.samples * innermost;
  return sum;
}

void check_close(const Counts<double>& counts, const Counts<double>& expected, double tolerance) {
  CHECK(counts.sphere_tests == Approx(expected.sphere_tests).epsilon(tolerance));
  CHECK(counts.rebuilds == Approx(expected.rebuilds).epsilon(tolerance));
  CHECK(counts.copies == Approx(expected.copies).epsilon(tolerance));
  CHECK(counts.disc_tests == Approx(expected.disc_tests).epsilon(tolerance));
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("the counts are the sums over the spheres") {
    support::RandomNumbers random(11);
    for (int run = 0; run < 60; ++run) {
      auto [w, ratio] = support::random_workload(random);
      w.dimension = random.uniform(1, 3);
      const SphereCacheParameters parameters{ratio, random.whole(1, 60), SampleOrder::lebesgue};
      const Counts<double> counts = sphere_cache_counts(w, parameters);
      check_close(counts, summed(w, parameters), 1e-12);
      CHECK(counts.sorted == w.samples);
      CHECK(counts.hits == expected_hits(w));
      CHECK(counts.steps + counts.nodes + counts.references + counts.placements == 0);
    }
    check_close(sphere_cache_counts(typical, {0.999, 4096}), summed(typical, {0.999, 4096}), 1e-12);
  }

  TEST_CASE("the rays in S_i are n_R Q^2i within 1e-13") {
    support::RandomNumbers random(12);
    double worst = 0;
    for (int run = 0; run < 300; ++run) {
      const auto [w, ratio] = support::random_workload(random);
      for (const SphereLevel& level : sphere_levels(w, {ratio, 40}, 40)) {
        const support::Exact shrunk = support::power(ratio, level.i);
        worst = std::max(worst, support::relative_error(level.rays, w.rays * shrunk * shrunk));
      }
    }
    CHECK_MESSAGE(worst < 1e-13, "largest relative error seen: ", worst);
  }

  TEST_CASE("lists hold no more than the rays of their sphere, nor than the list around; rebuilds grow inwards") {
    support::RandomNumbers random(13);
    for (int run = 0; run < 300; ++run) {
      auto [w, ratio] = support::random_workload(random);
      w.dimension = random.uniform(1, 3);
      const auto order = random.whole(0, 1) == 0 ? SampleOrder::none : SampleOrder::lebesgue;
      SphereLevel outer{.radius = w.sphere_radius, .rays = w.rays, .listed = w.rays, .rebuilds = 1};
      for (const SphereLevel& level : sphere_levels(w, {ratio, 40, order}, 40)) {
        REQUIRE(level.i == outer.i + 1);
        REQUIRE(level.radius <= outer.radius);
        REQUIRE(level.rays <= outer.rays);
        REQUIRE(level.listed <= level.rays * (1 + 1e-14));
        REQUIRE(level.listed <= outer.listed);
        REQUIRE(level.listed >= 0);
        REQUIRE(level.rebuilds >= outer.rebuilds);
        REQUIRE(level.rebuilds <= w.samples);
        REQUIRE(level.tests == outer.listed);
        outer = level;
      }
    }
  }

  TEST_CASE("the first spheres are the same, however many follow") {
    const auto all = sphere_levels(typical, {0.6, 9}, 9);
    const auto first = sphere_levels(typical, {0.6, 9}, 4);
    const auto fewer = sphere_levels(typical, {0.6, 3}, 100);
    REQUIRE(all.size() == 9);
    REQUIRE(first.size() == 4);
    REQUIRE(fewer.size() == 3);
    for (std::size_t i = 0; i < 4; ++i) CHECK(first[i].listed == all[i].listed);
    for (std::size_t i = 0; i < 3; ++i) CHECK(fewer[i].rebuilds == all[i].rebuilds);
    CHECK(sphere_levels(typical, {0.6, 9}, 0).empty());
  }

  TEST_CASE("more spheres than 4096 up to 20 000 are grouped within 2.5 % of the sum over all") {
    for (const std::int64_t k : {4097, 5000, 8191, 8192, 12345, 20000}) {
      CAPTURE(k);
      const double ratio = std::exp(-4.0 / static_cast<double>(k));
      const SphereCacheParameters parameters{ratio, k};
      check_close(sphere_cache_counts(typical, parameters), summed(typical, parameters), 0.025);
    }
  }

  TEST_CASE("unsorted samples are not sorted, and need more rebuilds") {
    for (const double ratio : {0.3, 0.5, 0.65, 0.8}) {
      const Counts<double> none = sphere_cache_counts(typical, {ratio, 5, SampleOrder::none});
      const Counts<double> lebesgue = sphere_cache_counts(typical, {ratio, 5, SampleOrder::lebesgue});
      CHECK(none.sorted == 0);
      CHECK(none.rebuilds > lebesgue.rebuilds);
      CHECK(none.sphere_tests > lebesgue.sphere_tests);
    }
  }

  TEST_CASE("spheres that share their centres with all around hold all their rays") {
    const SphereLevel sphere{.i = 3, .radius = 0.2, .rebuilds = 50};
    CHECK(listed_share(sphere, {}) == 1);
    CHECK(listed_share(sphere, {{0.4, 50, 0.39}, {0.8, 50, 0.79}}) == 1);
    CHECK(listed_share(sphere, {{0.4, 20, 0.39}}) < 1);
    CHECK(listed_share(sphere, {{0.4, 20, 0.39}, {0.8, 5, 0.79}}) < listed_share(sphere, {{0.4, 20, 0.39}}));
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("one sphere: built for the first sample at least, tested against all rays") {
    const auto levels = sphere_levels(typical, {0.5, 1}, 1);
    REQUIRE(levels.size() == 1);
    CHECK(levels[0].tests == 1e6);
    CHECK(levels[0].rebuilds >= 1);
    CHECK(levels[0].rays == Approx(250'000).epsilon(1e-12));
    CHECK(levels[0].listed < levels[0].rays);  // it pokes out of S0 at the cube's corners
    CHECK(levels[0].listed > 0.9 * levels[0].rays);
    const Counts<double> counts = sphere_cache_counts(typical, {0.5, 1});
    CHECK(counts.disc_tests == Approx(levels[0].listed * typical.samples).epsilon(1e-12));
  }

  TEST_CASE("a sphere as large as the disc is built for each sample") {
    const Workload w = cube_workload(1e6, 1e5, 0.01, 2);
    const double ratio = w.disc_radius / w.sphere_radius * (1 - 1e-15);
    CHECK(sphere_levels(w, {ratio, 1}, 1)[0].rebuilds == w.samples);
  }

  TEST_CASE("spheres too small for a double hold no rays, and are built for each sample") {
    const Counts<double> counts = sphere_cache_counts(typical, {0.3, 2000});
    CHECK(all_finite(counts));
    CHECK(counts.disc_tests == 0);
    CHECK(sphere_levels(typical, {0.3, 2000}, 2000).back().rebuilds == typical.samples);
  }

  TEST_CASE("1e15 spheres have finite counts, whatever the ratio") {
    for (const double ratio : {0.05, 0.65, 0.999, 1 - 1e-12, 1 - 0x1p-53})
      for (const std::int64_t k : {100'000LL, 1'000'000'000LL, 1'000'000'000'000'000LL})
        for (const auto order : {SampleOrder::lebesgue, SampleOrder::none})
          CHECK(all_finite(sphere_cache_counts(typical, {ratio, k, order})));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a ratio, a number of spheres or a workload out of range is refused by name") {
    for (const double bad : support::not_a_ratio) {
      CHECK_THROWS_WITH_AS((void)sphere_levels(typical, {bad, 3}, 3), Contains("radius ratio Q"),
                           std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)sphere_cache_counts(typical, {bad, 3}), Contains("radius ratio Q"),
                           std::invalid_argument);
    }
    for (const std::int64_t bad : {0LL, -1LL, 2'000'000'000'000'000'000LL}) {
      CHECK_THROWS_WITH_AS((void)sphere_levels(typical, {0.5, bad}, 3), Contains("number of spheres"),
                           std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)sphere_cache_counts(typical, {0.5, bad}), Contains("number of spheres"),
                           std::invalid_argument);
    }
    for (const double bad : support::not_a_length) {
      Workload w = typical;
      w.disc_radius = bad;
      CHECK_THROWS_WITH_AS((void)sphere_levels(w, {0.5, 3}, 3), Contains("disc radius"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)sphere_cache_counts(w, {0.5, 3}), Contains("disc radius"), std::invalid_argument);
    }
  }

  TEST_CASE("a sphere never built, or a radius that is none, has no share") {
    const SphereLevel sphere{.i = 3, .radius = 0.2, .rebuilds = 50};
    for (const double bad : support::not_a_size)
      CHECK_THROWS_WITH_AS((void)listed_share(sphere, {{0.4, 20, bad}}), Contains("reach of the offsets"),
                           std::invalid_argument);
    for (const double bad : support::not_a_length)
      CHECK_THROWS_WITH_AS((void)listed_share({.radius = 0.2, .rebuilds = bad}, {{0.4, 20, 0.39}}),
                           Contains("rebuilds of the sphere"), std::invalid_argument);
    for (const double bad : support::not_a_size) {
      CHECK_THROWS_WITH_AS((void)listed_share({.radius = bad, .rebuilds = 9}, {{0.4, 2, 0.39}}),
                           Contains("sphere radius"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)listed_share(sphere, {{bad, 20, 0.39}}), Contains("sphere radius"),
                           std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)listed_share(sphere, {{0.4, bad, 0.39}}), Contains("rebuilds of the outer sphere"),
                           std::invalid_argument);
    }
  }
}
