#include "detp/model/sphere_cache/sphere_cache_published.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "detp/model/lines/line_measure.hpp"
#include "support/not_a_length.hpp"
#include "support/random_workload.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Contains;

namespace {

const Workload some = {.rays = 1000, .samples = 100, .disc_radius = 0.01, .sphere_radius = 1, .box = {1, 1, 1}};

}  // namespace

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
