#include "detp/sim/search/irradiance.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/streamed.hpp"
#include "detp/sim/technique/technique.hpp"
#include "support/candidates.hpp"
#include "support/same_bytes.hpp"

using namespace detp;
using namespace detp::sim;
using support::one_of_each;

namespace {

const Candidate box_tree{Technique::box_tree, BoxTreeParameters{4, 4}};

/// The standard error of each disc's irradiance, from the sample variance of the photons' shares.
std::vector<double> by_definition(const PathRays& paths, std::span<const Disc> discs, const Outcome& outcome) {
  const std::size_t photons = paths.photons.empty() ? paths.rays.size() : paths.photons.back() + 1;
  std::vector<std::vector<double>> shares(discs.size(), std::vector<double>(photons, 0.0));
  for (const Pair& pair : outcome.pairs)
    shares[pair.disc][paths.photons.empty() ? pair.ray : paths.photons[pair.ray]] +=
        paths.rays[pair.ray].power / (std::numbers::pi * std::pow(discs[pair.disc].radius, 2));
  std::vector<double> errors;
  const auto n = static_cast<double>(photons);
  for (const std::vector<double>& of_disc : shares) {
    double mean = 0;
    double hit = 0;
    for (const double share : of_disc) mean += share / n;
    for (const double share : of_disc) hit += share > 0 ? 1 : 0;
    double squares = 0;
    for (const double share : of_disc) squares += std::pow(share - mean, 2);
    errors.push_back(hit < 2 ? unbounded : std::sqrt(n * squares / (n - 1)));
  }
  return errors;
}

/// Numbers of photons, each with 1 to 5 rays.
std::vector<std::uint64_t> few_rays_each(std::size_t rays) {
  std::vector<std::uint64_t> photons;
  for (std::uint64_t photon = 0; photons.size() < rays; ++photon)
    photons.insert(photons.end(), 1 + static_cast<std::size_t>(5 * uniform4(6, Stream::tests, photon)[0]), photon);
  photons.resize(rays);
  return photons;
}

}  // namespace

TEST_SUITE("standard error of irradiance") {
  TEST_CASE("It is that of the sample variance of whole photons, the same bytes by every technique and in blocks") {
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 60, 0.5, 3);
    std::vector<Ray> rays = LineField(enclosing_sphere(discs), 4).lines(0, 6000);
    const std::vector<std::uint64_t> photons = few_rays_each(rays.size());
    enum class Powers { same, change, random };
    for (const Powers powers : {Powers::same, Powers::change, Powers::random})
      for (const bool numbered : {false, true}) {
        CAPTURE(numbered);
        for (std::size_t i = 0; i < rays.size(); ++i) {
          if (powers == Powers::same) rays[i].power = 3;
          if (powers == Powers::change) rays[i].power = i < 300 ? 3 : 0.5;
          if (powers == Powers::random) rays[i].power = uniform4(5, Stream::tests, i)[0];
        }
        const PathRays paths = numbered ? PathRays{rays, photons, {}} : PathRays{rays};
        const Problem problem = make_problem(paths, discs);
        const Outcome outcome = run(problem, box_tree, {.pairs = true, .standard_error = true});
        const std::vector<double> expected = by_definition(paths, discs, outcome);
        int finite = 0;
        for (std::size_t d = 0; d < discs.size(); ++d) {
          finite += std::isfinite(expected[d]) ? 1 : 0;
          if (std::isfinite(expected[d]))
            CHECK(outcome.standard_error[d] == doctest::Approx(expected[d]).epsilon(1e-12));
          CHECK(std::isfinite(outcome.standard_error[d]) == std::isfinite(expected[d]));
        }
        CHECK(finite > 20);
        support::check_same_by_all(problem, outcome, {one_of_each(), support::both_engines, {1, 2}},
                                   {.standard_error = true});
        if (numbered) continue;  // rays in memory have no photon numbers
        const StreamOptions options{.run = {.standard_error = true}, .block = 100};
        const StreamedOutcome streamed = run_streamed(discs, RaysInMemory(rays), box_tree, options);
        CHECK(streamed.outcome.standard_error == outcome.standard_error);
        CHECK(streamed.outcome.upper_bound == outcome.upper_bound);
      }
  }

  TEST_CASE("Rays of one photon count as one: taken for independent, they would have a smaller error") {
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 20, 0.8, 3);
    std::vector<Ray> rays = LineField(enclosing_sphere(discs), 4).lines(0, 2000);
    std::vector<std::uint64_t> photons;
    for (std::size_t i = 0; i < rays.size(); ++i) photons.push_back(i / 4);
    for (std::size_t i = 0; i < rays.size(); ++i)
      rays[i] = rays[i - i % 4];  // a photon crosses each of its discs four times
    const Outcome whole = run(make_problem(PathRays{rays, photons, {}}, discs), box_tree, {.standard_error = true});
    const Outcome apart = run(make_problem(rays, discs), box_tree, {.standard_error = true});
    for (std::size_t d = 0; d < discs.size(); ++d)
      if (std::isfinite(whole.standard_error[d]))
        CHECK(whole.standard_error[d] == doctest::Approx(2 * apart.standard_error[d]).epsilon(0.02));
  }

  TEST_CASE("It is empty unless asked for; with fewer than 10 photons it is weak, with fewer than two infinite") {
    const auto result = [](const Outcome& one, std::size_t disc) {
      return DiscResult{one.hits[disc], one.irradiance[disc], one.standard_error[disc], one.upper_bound[disc]};
    };
    const std::vector<Disc> discs{{{0, 0, 0}, {0, 0, 1}, 1}, {{5, 0, 0}, {0, 0, 1}, 1}};
    const std::vector<Ray> nine(9, Ray{{0, 0, 1}, {0, 0, -1}, unbounded, 2});
    CHECK(run(make_problem(nine, discs), box_tree).standard_error.empty());
    const Outcome few = run(make_problem(nine, discs), box_tree, {.standard_error = true});
    CHECK(few.standard_error[0] == 0);  // all rays hit
    CHECK(is_weak(result(few, 0)));
    CHECK(std::isinf(few.standard_error[1]));
    CHECK(is_weak(result(few, 1)));
    std::vector<Ray> two_of_four(4, Ray{{0, 0, 1}, {0, 0, -1}, unbounded, 2});
    two_of_four[1].origin.x = two_of_four[2].origin.x = 20;
    const Outcome half = run(make_problem(two_of_four, discs), box_tree, {.standard_error = true});
    CHECK(half.standard_error[0] == doctest::Approx(std::sqrt(4.0 / 3 * (8 - 4)) / std::numbers::pi));
    CHECK(is_weak(result(half, 0)));
    two_of_four[0].origin.x = 20;
    CHECK(std::isinf(run(make_problem(two_of_four, discs), box_tree, {.standard_error = true}).standard_error[0]));
    const double each = 2 / std::numbers::pi;
    CHECK(few.upper_bound[0] == doctest::Approx(15.70521642 * each).epsilon(1e-9));
    CHECK(few.upper_bound[1] == doctest::Approx(-std::log(0.05) * each).epsilon(1e-12));
    const std::vector<Ray> ten(10, nine.front());
    const std::vector<std::uint64_t> two_photons{0, 0, 0, 0, 0, 1, 1, 1, 1, 1};
    const Outcome enough = run(make_problem(ten, discs), box_tree, {.standard_error = true});
    CHECK(enough.standard_error[0] == 0);  // all rays hit
    CHECK(enough.upper_bound[0] == enough.irradiance[0]);
    CHECK_FALSE(is_weak(result(enough, 0)));
    const Outcome two = run(make_problem(PathRays{ten, two_photons, {}}, discs), box_tree, {.standard_error = true});
    CHECK(is_weak(result(two, 0)));
    // u_2 = 6.2958: two photons of weight 10 were seen.
    CHECK(two.upper_bound[0] == doctest::Approx(10 * 6.295793622 / std::numbers::pi).epsilon(1e-9));
  }

  TEST_CASE("If one photon brings more than a tenth of the sum of squares, the error is weak") {
    const std::vector<Disc> discs{{{0, 0, 0}, {0, 0, 1}, 1}};
    std::vector<Ray> rays(50, Ray{{0, 0, 1}, {0, 0, -1}, unbounded, 1});
    rays.front().power = 2;  // 4 of 53
    CHECK(std::isfinite(run(make_problem(rays, discs), box_tree, {.standard_error = true}).standard_error[0]));
    rays.front().power = 3;  // 9 of 58
    const Outcome outcome = run(make_problem(rays, discs), box_tree, {.standard_error = true});
    CHECK(is_weak({50, outcome.irradiance[0], outcome.standard_error[0], outcome.upper_bound[0]}));
    CHECK(outcome.standard_error[0] ==
          doctest::Approx(std::sqrt(50.0 / 49 * (58 - 52.0 * 52 / 50)) / std::numbers::pi));
    // k = 58/9, rounded up: u_7 - 7 = 6.1481
    CHECK(outcome.upper_bound[0] == doctest::Approx((52 + 3 * 6.148113802) / std::numbers::pi).epsilon(1e-8));
  }

  TEST_CASE("The bound of a disc allows for a photon as heavy as any that has hit another disc by many rays") {
    const std::vector<Disc> discs{{{0, 0, 0}, {0, 0, 1}, 1}, {{5, 0, 0}, {0, 0, 1}, 1}};
    std::vector<Ray> rays;
    std::vector<std::uint64_t> photons;
    for (std::uint64_t photon = 0; photon < 100; ++photon)
      for (int ray = 0; ray < (photon == 50 ? 8 : 1); ++ray) {
        rays.push_back({{0, 0, 1}, {0, 0, -1}, unbounded, 2});
        photons.push_back(photon);
      }
    for (const Candidate& candidate : one_of_each()) {
      const Outcome outcome =
          run(make_problem(PathRays{rays, photons, {}}, discs), candidate, {.standard_error = true});
      CHECK(outcome.hits[1] == 0);
      CHECK(outcome.upper_bound[1] * std::numbers::pi == doctest::Approx(8 * 2 * -std::log(0.05)));
    }
  }

  TEST_CASE("Extreme powers have the errors of ordinary ones, scaled, by every technique and in blocks" *
            doctest::test_suite("long")) {
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 60, 0.5, 3);
    std::vector<Ray> rays = LineField(enclosing_sphere(discs), 4).lines(0, 3000);
    const std::vector<std::uint64_t> photons = few_rays_each(rays.size());
    const auto with_powers = [&](int exponent, bool equal) {
      for (std::size_t i = 0; i < rays.size(); ++i)
        rays[i].power = std::ldexp(equal ? 0.75 : 0.25 + uniform4(5, Stream::tests, i)[0], exponent);
    };
    for (const bool numbered : {false, true})
      for (const bool equal : {false, true}) {
        const PathRays paths = numbered ? PathRays{rays, photons, {}} : PathRays{rays};
        with_powers(0, equal);
        const Outcome usual = run(make_problem(paths, discs), box_tree, {.standard_error = true});
        for (const int exponent : {-900, -660, 300, 660, 930})
          for (const Candidate& candidate : one_of_each())
            for (const Engine engine : support::both_engines) {
              INFO("exponent ", exponent, ", name(candidate.technique) ", name(candidate.technique));
              with_powers(exponent, equal);
              const Outcome extreme =
                  run(make_problem(paths, discs), candidate, {.standard_error = true, .engine = engine});
              for (std::size_t d = 0; d < discs.size(); ++d) {
                REQUIRE(extreme.standard_error[d] == std::ldexp(usual.standard_error[d], exponent));
                REQUIRE(extreme.upper_bound[d] == std::ldexp(usual.upper_bound[d], exponent));
              }
            }
        if (numbered) continue;
        const StreamOptions options{.run = {.standard_error = true}, .block = 100};
        const StreamedOutcome streamed = run_streamed(discs, RaysInMemory(rays), box_tree, options);
        for (std::size_t d = 0; d < discs.size(); ++d)
          CHECK(streamed.outcome.standard_error[d] == std::ldexp(usual.standard_error[d], 930));
      }
  }

  TEST_CASE("Powers that grow beyond all bounds from search to search have the errors of one search") {
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 60, 0.5, 3);
    std::vector<Ray> rays = LineField(enclosing_sphere(discs), 4).lines(0, 3000);
    for (const bool grow : {true, false}) {
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const std::size_t third = (grow ? i : rays.size() - 1 - i) / 1000;
        rays[i].power = std::ldexp(0.25 + uniform4(5, Stream::tests, i)[0], third == 0 ? -700 : third == 1 ? 0 : 700);
      }
      const Outcome whole = run(make_problem(rays, discs), box_tree, {.standard_error = true});
      CHECK(std::ranges::any_of(whole.standard_error, [](double one) { return std::isfinite(one); }));
      const StreamOptions options{.run = {.standard_error = true}, .block = 100};
      const StreamedOutcome streamed = run_streamed(discs, RaysInMemory(rays), box_tree, options);
      CHECK(streamed.outcome.standard_error == whole.standard_error);
      CHECK(streamed.outcome.upper_bound == whole.upper_bound);
    }
  }

  TEST_CASE("Without power there are bounds of 0, no zero errors") {
    const std::vector<Disc> discs{{{0, 0, 0}, {0, 0, 1}, 1}};
    const std::vector<Ray> rays(50, Ray{{0, 0, 1}, {0, 0, -1}, unbounded, 0});
    const Outcome outcome = run(make_problem(rays, discs), box_tree, {.standard_error = true});
    CHECK(std::isinf(outcome.standard_error[0]));
    CHECK(outcome.upper_bound[0] == 0);
  }

  TEST_CASE("Bounds of few hits hold in 95 % of cases") {
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 4000, 0.02, 7);
    const Sphere enclosing = enclosing_sphere(discs);
    for (const std::size_t n : {std::size_t{2000}, std::size_t{20'000}}) {  // 0.13 and 1.3 hits of a disc
      const std::vector<Ray> rays = LineField(enclosing, 8).lines(0, n);
      const Outcome outcome = run(make_problem(rays, discs), box_tree, {.standard_error = true});
      const double expected = static_cast<double>(n) / (2 * std::numbers::pi * enclosing.radius * enclosing.radius);
      int covered = 0;
      for (std::size_t d = 0; d < discs.size(); ++d) covered += expected <= outcome.upper_bound[d] ? 1 : 0;
      CHECK(covered / 4000.0 > 0.94);  // discrete: at least 95 %, but discs share rays
    }
  }

  TEST_CASE("About 95 % of discs see the expected irradiance within two standard errors") {
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 2000, 0.2, 7);
    const Sphere enclosing = enclosing_sphere(discs);
    constexpr std::size_t n = 40'000;
    const std::vector<Ray> rays = LineField(enclosing, 8).lines(0, n);
    const Outcome outcome = run(make_problem(rays, discs), box_tree, {.standard_error = true});
    // A line through S0 hits a disc of radius d with probability d^2 / (2 r0^2): the same irradiance for all discs.
    const double expected = n / (2 * std::numbers::pi * enclosing.radius * enclosing.radius);
    int covered = 0;
    for (std::size_t d = 0; d < discs.size(); ++d)
      covered += std::abs(outcome.irradiance[d] - expected) <= 1.96 * outcome.standard_error[d] ? 1 : 0;
    // 95 % of the 2000 intervals should contain `expected`. If they were independent, this share would have a standard
    // deviation of 0.5 %. It is larger because discs share rays.
    CHECK(covered / 2000.0 > 0.92);
    CHECK(covered / 2000.0 < 0.97);
  }

  TEST_CASE("A search of some of the rays refuses it") {
    const std::vector<Disc> discs{{{0, 0, 0}, {0, 0, 1}, 1}};
    const std::vector<Ray> rays{{{0, 0, 1}, {0, 0, -1}, 1}};
    Totals totals;
    CHECK_THROWS_WITH_AS((void)run(make_problem(rays, discs), box_tree, {.standard_error = true, .totals = &totals}),
                         doctest::Contains("Totals::keep_errors"), std::invalid_argument);
  }
}
