#include "detp/model/sphere_cache/sphere_cache.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "detp/model/lines/line_measure.hpp"
#include "support/high_precision.hpp"
#include "support/not_a_length.hpp"
#include "support/random_workload.hpp"
#include "support/workloads.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Approx;
using doctest::Contains;
using support::typical;

namespace {

/// Counts of some spheres, printed by `rebuild_law_table counted`: means over 400 sets of 10³ samples and 24 of 10⁵.
/// Their standard errors are below 1 % of m_i and below 0.005 of the listed share.
struct CountedSphere {
  double dimension, samples, disc_share, ratio;
  std::int64_t i;
  double rebuilds;
  double listed_share;
};

constexpr CountedSphere counted_spheres[] = {
    {2, 1000, 0.001, 0.5, 2, 185.35, 0.9549},   {2, 1000, 0.001, 0.5, 3, 427.50, 0.9450},
    {2, 1000, 0.001, 0.8, 2, 36.53, 0.7249},    {2, 1000, 0.001, 0.8, 8, 372.13, 0.7884},
    {2, 1000, 0.001, 0.9, 6, 86.07, 0.6483},    {2, 1000, 0.001, 0.9, 18, 465.76, 0.7406},
    {2, 1000, 0.05, 0.5, 2, 226.26, 0.9769},    {2, 1000, 0.05, 0.5, 3, 609.11, 0.9850},
    {2, 1000, 0.05, 0.8, 2, 40.21, 0.7573},     {2, 1000, 0.05, 0.8, 8, 484.08, 0.8806},
    {2, 1000, 0.05, 0.9, 6, 89.13, 0.6932},     {2, 1000, 0.05, 0.9, 18, 602.85, 0.8536},
    {2, 100000, 0.001, 0.5, 2, 295.62, 0.9616}, {2, 100000, 0.001, 0.5, 3, 1339.17, 0.9628},
    {2, 100000, 0.001, 0.8, 2, 53.92, 0.7442},  {2, 100000, 0.001, 0.8, 8, 943.92, 0.7819},
    {2, 100000, 0.001, 0.9, 6, 114.46, 0.6548}, {2, 100000, 0.001, 0.9, 18, 1926.62, 0.6912},
    {2, 100000, 0.05, 0.5, 2, 347.92, 0.9740},  {2, 100000, 0.05, 0.5, 3, 2597.25, 0.9880},
    {2, 100000, 0.05, 0.8, 2, 58.79, 0.7694},   {2, 100000, 0.05, 0.8, 8, 1719.54, 0.8738},
    {2, 100000, 0.05, 0.9, 6, 113.21, 0.7057},  {2, 100000, 0.05, 0.9, 18, 3152.29, 0.8229},
    {3, 1000, 0.001, 0.5, 2, 219.19, 0.9529},   {3, 1000, 0.001, 0.5, 3, 570.09, 0.9274},
    {3, 1000, 0.001, 0.8, 2, 28.15, 0.7468},    {3, 1000, 0.001, 0.8, 8, 488.27, 0.7660},
    {3, 1000, 0.001, 0.9, 6, 82.26, 0.6388},    {3, 1000, 0.001, 0.9, 18, 586.18, 0.7184},
    {3, 1000, 0.05, 0.5, 2, 295.27, 0.9755},    {3, 1000, 0.05, 0.5, 3, 788.30, 0.9799},
    {3, 1000, 0.05, 0.8, 2, 30.86, 0.7780},     {3, 1000, 0.05, 0.8, 8, 622.88, 0.8708},
    {3, 1000, 0.05, 0.9, 6, 89.84, 0.6803},     {3, 1000, 0.05, 0.9, 18, 744.31, 0.8456},
    {3, 100000, 0.001, 0.5, 2, 512.79, 0.9737}, {3, 100000, 0.001, 0.5, 3, 3804.54, 0.9749},
    {3, 100000, 0.001, 0.8, 2, 67.46, 0.7490},  {3, 100000, 0.001, 0.8, 8, 2208.17, 0.7607},
    {3, 100000, 0.001, 0.9, 6, 153.00, 0.6481}, {3, 100000, 0.001, 0.9, 18, 4721.04, 0.6572},
    {3, 100000, 0.05, 0.5, 2, 595.42, 0.9844},  {3, 100000, 0.05, 0.5, 3, 7422.71, 0.9890},
    {3, 100000, 0.05, 0.8, 2, 73.50, 0.7755},   {3, 100000, 0.05, 0.8, 8, 4874.83, 0.8626},
    {3, 100000, 0.05, 0.9, 6, 161.46, 0.6922},  {3, 100000, 0.05, 0.9, 18, 8377.62, 0.8072},
};

bool all_finite(const Counts<double>& counts) {
  bool finite = true;
  for_each_term(counts, [&](std::string_view, double term) { finite = finite && std::isfinite(term) && term >= 0; });
  return finite;
}

/// The counts by the header's sums over all levels.
Counts<double> summed(const Workload& w, const SphereCacheParameters& parameters) {
  Counts<double> sum;
  for (const SphereLevel& level : sphere_levels(w, parameters, parameters.spheres)) {
    sum.cull_tests += level.rebuilds * level.tests;
    sum.culls += level.rebuilds;
    sum.listed += level.rebuilds * level.listed;
    sum.disc_tests = w.samples * level.listed;  // L_k; without the factor of L"_k
  }
  return sum;
}

void check_close(const Counts<double>& counts, const Counts<double>& expected, double tolerance) {
  CHECK(counts.cull_tests == Approx(expected.cull_tests).epsilon(tolerance));
  CHECK(counts.culls == Approx(expected.culls).epsilon(tolerance));
  CHECK(counts.listed == Approx(expected.listed).epsilon(tolerance));
  CHECK(counts.disc_tests >= expected.disc_tests * (1 - 1e-14));
  CHECK(counts.disc_tests <= 1.15 * expected.disc_tests);
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

  TEST_CASE("lists hold at most the rays of their sphere and of the list around; rebuilds grow inwards") {
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
        REQUIRE(level.tests >= outer.listed);
        REQUIRE(level.tests <= outer.rays * (1 + 1e-14));
        if (level.rebuilds == outer.rebuilds || order == SampleOrder::none) REQUIRE(level.tests == outer.listed);
        outer = level;
      }
    }
  }

  TEST_CASE("the first spheres are the same for any number of spheres") {
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

  TEST_CASE("more spheres than 4096 are grouped within 0.3 % of the sum over all") {
    for (const double dimension : {2.0, 3.0})
      for (const std::int64_t k : {4097, 8192, 20'000, 50'000}) {
        INFO("dimension ", dimension, ", k ", k);
        const Workload w = cube_workload(1e6, 1e5, 0.01, 2, dimension);
        const double ratio = std::exp(std::log(w.disc_radius / w.sphere_radius) / static_cast<double>(k));
        check_close(sphere_cache_counts(w, {ratio, k}), summed(w, {ratio, k}), 0.003);
      }
  }

  TEST_CASE("spheres smaller than the disc, too many to sum, add the value of a geometric series") {
    const std::int64_t k = 1'000'000'000;
    const double ratio = std::exp(-20.0 / static_cast<double>(k));
    const Counts<double> all = sphere_cache_counts(typical, {ratio, k});
    const std::int64_t holding =
        static_cast<std::int64_t>(std::log(typical.disc_radius / typical.sphere_radius) / std::log(ratio));
    const Counts<double> held = sphere_cache_counts(typical, {ratio, holding});
    const double rays = typical.rays * std::pow(typical.disc_radius / typical.sphere_radius, 2);
    CHECK(all.culls - held.culls == Approx(typical.samples * static_cast<double>(k - holding)).epsilon(1e-4));
    CHECK(all.listed - held.listed ==
          Approx(typical.samples * rays / (2 * 20.0 / static_cast<double>(k))).epsilon(0.01));
  }

  TEST_CASE("unsorted samples are not sorted, and need more rebuilds") {
    for (const double ratio : {0.3, 0.5, 0.65, 0.8}) {
      const Counts<double> none = sphere_cache_counts(typical, {ratio, 5, SampleOrder::none});
      const Counts<double> lebesgue = sphere_cache_counts(typical, {ratio, 5, SampleOrder::lebesgue});
      CHECK(none.sorted == 0);
      CHECK(none.culls > lebesgue.culls);
      CHECK(none.cull_tests > lebesgue.cull_tests);
    }
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("rebuilds are within 8 %, listed rays within 4 %, of counts") {
    double rebuilds = 0;
    double listed = 0;
    double published = 0;
    for (const CountedSphere& counted : counted_spheres) {
      const double d = counted.disc_share * std::sqrt(3.0) / (1 - counted.disc_share);
      const Workload w = cube_workload(1e6, counted.samples, d, 2, counted.dimension);
      const SphereLevel sphere = sphere_levels(w, {counted.ratio, counted.i}, counted.i).back();
      INFO("counted.dimension ", counted.dimension, ", counted.samples ", counted.samples, ", counted.disc_share ",
           counted.disc_share, ", counted.ratio ", counted.ratio, ", counted.i ", counted.i);
      CHECK(sphere.rebuilds == Approx(counted.rebuilds).epsilon(0.08));
      CHECK(sphere.listed / sphere.rays == Approx(counted.listed_share).epsilon(0.04));
      rebuilds += std::abs(std::log(sphere.rebuilds / counted.rebuilds));
      listed += std::abs(std::log(sphere.listed / sphere.rays / counted.listed_share));
      published +=
          std::abs(std::log(std::pow(counted.ratio, -3.0 * static_cast<double>(counted.i)) / counted.rebuilds));
    }
    const double spheres = std::size(counted_spheres);
    CHECK_MESSAGE(rebuilds / spheres < 0.015, "mean deviation of rebuilds: ", rebuilds / spheres);
    CHECK_MESSAGE(listed / spheres < 0.01, "mean deviation of listed rays: ", listed / spheres);
    CHECK_MESSAGE(published / spheres > 0.5, "the published form is far off: ", published / spheres);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("one sphere: built at least for the first sample, tested against all rays") {
    const auto levels = sphere_levels(typical, {0.5, 1}, 1);
    REQUIRE(levels.size() == 1);
    CHECK(levels[0].tests == 1e6);
    CHECK(levels[0].rebuilds >= 1);
    CHECK(levels[0].rays == Approx(250'000).epsilon(1e-12));
    CHECK(levels[0].listed < levels[0].rays);  // it extends outside S0 at the cube's corners
    CHECK(levels[0].listed > 0.9 * levels[0].rays);
    const Counts<double> counts = sphere_cache_counts(typical, {0.5, 1});
    CHECK(counts.disc_tests > levels[0].listed * typical.samples);
    CHECK(counts.disc_tests < 1.02 * levels[0].listed * typical.samples);
  }

  TEST_CASE("no sphere: each disc is tested with all rays, for any ratio and order") {
    for (const auto order : {SampleOrder::lebesgue, SampleOrder::none}) {
      const Counts<double> counts = sphere_cache_counts(typical, {0.5, 0, order});
      CHECK(counts.disc_tests == typical.rays * typical.samples);
      CHECK(counts.cull_tests == 0);
      CHECK(counts.listed == 0);
      CHECK(counts.culls == 0);
      CHECK(sphere_levels(typical, {0.5, 0, order}, 3).empty());
    }
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

  TEST_CASE("9e18 spheres have finite counts, for any ratio") {
    for (const double ratio : {0.05, 0.65, 0.999, 1 - 1e-12, 1 - 0x1p-53})
      for (const std::int64_t k : {100'000LL, 1'000'000'000LL, 9'000'000'000'000'000'000LL})
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
    for (const std::int64_t bad : {-1LL, 9'100'000'000'000'000'000LL}) {
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
}
