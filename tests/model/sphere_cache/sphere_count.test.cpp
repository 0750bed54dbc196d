#include "detp/model/sphere_cache/sphere_count.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>

#include "support/high_precision.hpp"
#include "support/not_a_length.hpp"
#include "support/random_workload.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Contains;
using support::Exact;

namespace {

struct Case {
  double ratio;
  double disc;
  double outer;
};

std::int64_t count(Form form, const Case& c) { return sphere_count(form, {c.ratio}, {c.disc}, {c.outer}); }

Exact radius(const Case& c, std::int64_t i) { return c.outer * support::power(c.ratio, i); }

/// Corrected: r_k >= d > r_{k+1}.  Published: r_k <= d < r_{k-1}.
bool right(const Case& c) {
  const std::int64_t corrected = count(Form::corrected, c);
  const std::int64_t published = count(Form::published, c);
  return corrected >= 0 && published >= 1 && radius(c, corrected) >= c.disc && radius(c, corrected + 1) < c.disc &&
         radius(c, published) <= c.disc && radius(c, published - 1) > c.disc;
}

/// Checks the case, and the cases with d one ulp larger and smaller.
int wrong_around(const Case& c) {
  int wrong = 0;
  for (const double d : {c.disc, std::nextafter(c.disc, 0.0), std::nextafter(c.disc, c.outer)})
    if (d < c.outer) wrong += !right({c.ratio, d, c.outer});
  return wrong;
}

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("r_k >= d > r_{k+1}, and the smallest r_k <= d, in 100 digits on 20 000 random workloads") {
    support::RandomNumbers random(7);
    int wrong = 0;
    for (int run = 0; run < 20'000; ++run) {
      const auto [w, ratio] = support::random_workload(random);
      wrong += !right({ratio, w.disc_radius, w.sphere_radius});
    }
    CHECK(wrong == 0);
  }

  TEST_CASE("near a tie, d = fl(r0 Q^j) and one ulp to either side, the count is right") {
    support::RandomNumbers random(8);
    int wrong = 0;
    for (int run = 0; run < 5'000; ++run) {
      const double ratio = random.uniform(0.05, 0.99);
      const double outer = random.log_uniform(1e-3, 1e3);
      wrong += wrong_around({ratio, outer * std::pow(ratio, static_cast<double>(random.whole(1, 60))), outer});
    }
    CHECK(wrong == 0);
  }

  TEST_CASE("Q next to 1 and millions of spheres: the count is right") {
    for (const double gap : {0x1p-10, 0x1p-30, 0x1.3p-45, 0x1p-53})
      for (const double d : {0.9, 0.5, 1e-3, 1e-6, 1e-300}) CHECK(wrong_around({1 - gap, d, 1}) == 0);
  }

  TEST_CASE("a disc a few ulps smaller than S0 and Q a few ulps below 1: the count is right") {
    support::RandomNumbers random(10);
    int wrong = 0;
    for (int run = 0; run < 5'000; ++run) {
      const double outer = std::ldexp(1 + random.log_uniform(1e-15, 1), static_cast<int>(random.whole(-1000, 1000)));
      double disc = outer;
      for (std::int64_t steps = random.whole(1, 8); steps > 0; --steps) disc = std::nextafter(disc, 0.0);
      wrong += !right({1 - static_cast<double>(random.whole(1, 4)) * 0x1p-53, disc, outer});
    }
    CHECK(wrong == 0);
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
}
