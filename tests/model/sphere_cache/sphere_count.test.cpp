#include "detp/model/sphere_cache/sphere_count.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "detp/model/lines/line_measure.hpp"
#include "detp/model/sphere_cache/listed_rays.hpp"
#include "detp/model/sphere_cache/sample_spread.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "support/not_a_length.hpp"
#include "support/random_workload.hpp"
#include "support/workloads.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Approx;
using doctest::Contains;
using support::typical;

namespace {

struct Case {
  double ratio;
  double disc;
  double outer;
};

std::int64_t count(Form form, const Case& c) { return sphere_count(form, {c.ratio}, {c.disc}, {c.outer}); }

const Workload some = {.rays = 1000, .samples = 100, .disc_radius = 0.01, .sphere_radius = 1, .box = {1, 1, 1}};

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("the mean square distance from the centre agrees with samples drawn in a cube and on its faces to 1 %") {
    for (const auto& [body, dimension] : {std::pair{sim::Body::cube, 3.0}, {sim::Body::cube_faces, 2.0}}) {
      double mean = 0;
      const auto discs = sim::uniform_discs(body, 2, 100'000, 0.1, 5);
      for (const sim::Disc& disc : discs) mean += glm::dot(disc.centre, disc.centre) / 1e5;
      const double expected = model::mean_square_distance(cube_workload(1, 1e5, 0.1, 2, dimension));
      CHECK(expected == doctest::Approx(mean).epsilon(0.01));
      CHECK(1.03 * expected != doctest::Approx(mean).epsilon(0.01));
    }
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("at a tie r_j = d both counts are j; one ulp to either side they differ") {
    for (const double ratio : {0.5, 0.25, 0.0625})
      for (const double outer : {1.0, 0x1p40, 0x1p-40})
        for (std::int64_t j = 1; j <= 100; ++j) {
          const double d = outer * std::pow(ratio, static_cast<double>(j));
          REQUIRE(count(Form::corrected, {ratio, d, outer}) == j);
          REQUIRE(count(Form::published, {ratio, d, outer}) == j);
          const double less = std::nextafter(d, 0.0);
          REQUIRE(count(Form::corrected, {ratio, less, outer}) == j);
          REQUIRE(count(Form::published, {ratio, less, outer}) == j + 1);
          const double more = std::nextafter(d, outer);
          REQUIRE(count(Form::corrected, {ratio, more, outer}) == j - 1);
          REQUIRE(count(Form::published, {ratio, more, outer}) == j);
        }
  }

  TEST_CASE("for a disc as large as S0 or larger no sphere pays off") {
    for (const Form form : {Form::published, Form::corrected}) {
      CHECK(count(form, {0.65, 1, 1}) == 0);
      CHECK(count(form, {0.65, 7, 1}) == 0);
    }
  }

  TEST_CASE("the paper's advice Q = 0.65 for d = r0/100: ten and eleven spheres") {
    CHECK(count(Form::corrected, {0.65, 0.01, 1}) == 10);
    CHECK(count(Form::published, {0.65, 0.01, 1}) == 11);
  }

  TEST_CASE("more than 9e18 spheres are refused, a few fewer are counted") {
    const double next_to_1 = 1 - 0x1p-53;
    CHECK(count(Form::corrected, {next_to_1, 1e-300, 1}) == doctest::Approx(300 * std::log(10.0) * 0x1p53));
    CHECK_THROWS_WITH_AS((void)sphere_count(Form::corrected, {next_to_1}, {5e-324}, {1.7e308}), Contains("9e18"),
                         std::overflow_error);
  }

  TEST_CASE("the forms have names") {
    CHECK(name(Form::published) == "published");
    CHECK(name(Form::corrected) == "corrected");
  }

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

TEST_SUITE("bad input") {
  TEST_CASE("a ratio or a radius out of range is refused by name") {
    for (const Form form : {Form::published, Form::corrected}) {
      for (const double bad : support::not_a_ratio)
        CHECK_THROWS_WITH_AS((void)count(form, {bad, 0.1, 1}), Contains("radius ratio Q"), std::invalid_argument);
      for (const double bad : support::not_a_length) {
        CHECK_THROWS_WITH_AS((void)count(form, {0.5, bad, 1}), Contains("disc radius"), std::invalid_argument);
        CHECK_THROWS_WITH_AS((void)count(form, {0.5, 0.1, bad}), Contains("sphere radius"), std::invalid_argument);
      }
    }
  }

  TEST_CASE("an invalid radius, ratio or workload is refused by name") {
    for (const double bad : support::not_a_size) {
      CHECK_THROWS_WITH_AS((void)rays_through(typical, bad), Contains("sphere radius"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)listed_share(typical, bad, 0.3), Contains("sphere radius"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)listed_share(typical, 0.3, bad), Contains("octaves"), std::invalid_argument);
    }
    for (const double bad : support::not_a_length) {
      Workload w = typical;
      w.disc_radius = bad;
      CHECK_THROWS_WITH_AS((void)listed_share(w, 0.3, 0.3), Contains("disc radius"), std::invalid_argument);
    }
  }

  TEST_CASE("unsorted: a sphere that is never built, or an invalid radius, has no share") {
    for (const double bad : support::not_a_length)
      CHECK_THROWS_WITH_AS((void)unsorted_listed_share(0.2, bad, {{0.4, 20, 0.39}}), Contains("rebuilds of the sphere"),
                           std::invalid_argument);
    for (const double bad : support::not_a_size) {
      CHECK_THROWS_WITH_AS((void)unsorted_listed_share(0.2, 50, {{0.4, 20, bad}}), Contains("reach of the offsets"),
                           std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)unsorted_listed_share(bad, 9, {{0.4, 2, 0.39}}), Contains("sphere radius"),
                           std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)unsorted_listed_share(0.2, 50, {{bad, 20, 0.39}}), Contains("sphere radius"),
                           std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)unsorted_listed_share(0.2, 50, {{0.4, bad, 0.39}}),
                           Contains("rebuilds of the outer sphere"), std::invalid_argument);
    }
  }

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

TEST_SUITE("identity") {
  TEST_CASE("the listed share is from 0 to 1; it is 1 for spheres as small as the disc, or if samples are few") {
    support::RandomNumbers random(21);
    for (int run = 0; run < 5000; ++run) {
      auto [w, ratio] = support::random_workload(random);
      w.dimension = random.uniform(1, 3);
      const double octaves = random.log_uniform(1e-9, 6);
      const double share = listed_share(w, w.sphere_radius * random.log_uniform(1e-8, 1), octaves);
      REQUIRE(share >= 0);
      REQUIRE(share <= 1);
      REQUIRE(listed_share(w, w.disc_radius, octaves) == 1);
      REQUIRE(listed_share(w, 0.3 * w.disc_radius, octaves) == 1);
    }
    const Workload few = cube_workload(1e6, 1, 1e-6, 2);
    CHECK(listed_share(few, 1e-5, 0.3) == Approx(1).epsilon(0.01));
  }

  TEST_CASE("spheres of very different size list nearly all their rays, those of similar size fewer") {
    for (const double dimension : {2.0, 2.5, 3.0}) {
      const Workload w = cube_workload(1e6, 1e6, 1e-4, 2, dimension);
      double before = 1;
      for (const double octaves : {4.0, 2.0, 1.0, 0.6, 0.4, 0.2, 0.1, 0.05, 0.0}) {
        const double share = listed_share(w, 0.02, octaves);
        CHECK(share < before);
        before = share;
      }
      CHECK(before > 0.5);
      CHECK(listed_share(w, 0.02, 4) > 0.99);
    }
  }

  TEST_CASE("the listed share is continuous, and does not depend on the unit of length") {
    support::RandomNumbers random(22);
    for (int run = 0; run < 2000; ++run) {
      const double dimension = random.uniform(2, 3);
      const Workload w = cube_workload(1e6, random.count(10, 1e8), random.log_uniform(1e-4, 0.3), 2, dimension);
      const double radius = w.disc_radius + (w.sphere_radius - w.disc_radius) * random.uniform(0.001, 0.98);
      const double octaves = random.uniform(0, 3);
      const double share = listed_share(w, radius, octaves);
      REQUIRE(listed_share(w, radius * (1 + 1e-9), octaves) == Approx(share).epsilon(1e-6));
      REQUIRE(listed_share(w, radius, octaves + 1e-9) == Approx(share).epsilon(1e-6));
      const Workload scaled = cube_workload(1e6, w.samples, 1e6 * w.disc_radius, 2e6, dimension);
      REQUIRE(listed_share(scaled, 1e6 * radius, octaves) == Approx(share).epsilon(1e-9));
    }
  }

  TEST_CASE("rays through a sphere inside S0 are proportional to its area") {
    CHECK(rays_through(typical, typical.sphere_radius) == Approx(1e6).epsilon(1e-14));
    CHECK(rays_through(typical, typical.sphere_radius / 4) == Approx(62'500).epsilon(1e-14));
    CHECK(rays_through(typical, 0) == 0);
  }

  TEST_CASE("unsorted: spheres with the same centre as all around them list all their rays") {
    CHECK(unsorted_listed_share(0.2, 50, {}) == 1);
    CHECK(unsorted_listed_share(0.2, 50, {{0.4, 50, 0.39}, {0.8, 50, 0.79}}) == 1);
    const double one = unsorted_listed_share(0.2, 50, {{0.4, 20, 0.39}});
    CHECK(one < 1);
    CHECK(unsorted_listed_share(0.2, 50, {{0.4, 20, 0.39}, {0.8, 5, 0.79}}) < one);
  }

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
