#include "detp/sim/search/power_squares.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "detp/sim/geometry/random.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/scene/open/uniform_discs.hpp"
#include "detp/sim/technique/streamed.hpp"
#include "detp/sim/technique/technique.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

const Candidate box_tree{Technique::box_tree, BoxTreeParameters{4, 4}};

/// The standard error of each disc's irradiance, from the sample variance of the rays' shares.
std::vector<double> by_definition(std::span<const Ray> rays, std::span<const Disc> discs, const Outcome& outcome) {
  std::vector<std::vector<double>> shares(discs.size(), std::vector<double>(rays.size(), 0.0));
  for (const Pair& pair : outcome.pairs)
    shares[pair.disc][pair.ray] = rays[pair.ray].power / (std::numbers::pi * std::pow(discs[pair.disc].radius, 2));
  std::vector<double> errors;
  const auto n = static_cast<double>(rays.size());
  for (const std::vector<double>& of_disc : shares) {
    double mean = 0;
    for (const double share : of_disc) mean += share / n;
    double squares = 0;
    for (const double share : of_disc) squares += std::pow(share - mean, 2);
    errors.push_back(std::sqrt(n * squares / (n - 1)));
  }
  return errors;
}

}  // namespace

TEST_SUITE("standard error of irradiance") {
  TEST_CASE("It is that of the sample variance of the rays, for one power and for many, in one run and in blocks") {
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 60, 0.5, 3);
    std::vector<Ray> rays = LineField(enclosing_sphere(discs), 4).lines(0, 500);
    enum class Powers { same, change, random };
    for (const Powers powers : {Powers::same, Powers::change, Powers::random}) {
      for (std::size_t i = 0; i < rays.size(); ++i) {
        if (powers == Powers::same) rays[i].power = 3;
        if (powers == Powers::change) rays[i].power = i < 300 ? 3 : 0.5;
        if (powers == Powers::random) rays[i].power = uniform4(5, Stream::tests, i)[0];
      }
      const Outcome outcome = run(make_problem(rays, discs), box_tree, {.pairs = true, .standard_error = true});
      const std::vector<double> expected = by_definition(rays, discs, outcome);
      const Outcome without_pairs = run(make_problem(rays, discs), box_tree, {.standard_error = true});
      CHECK(without_pairs.pairs.empty());
      CHECK(without_pairs.standard_error == outcome.standard_error);
      CHECK(without_pairs.irradiance == outcome.irradiance);
      StreamOptions options{.run = {.standard_error = true}, .block = 100};
      const StreamedOutcome streamed = run_streamed(discs, RaysInMemory(rays), box_tree, options);
      CHECK(streamed.outcome.pairs.empty());
      for (std::size_t d = 0; d < discs.size(); ++d) {
        CHECK(outcome.standard_error[d] == doctest::Approx(expected[d]).epsilon(1e-12));
        CHECK(streamed.outcome.standard_error[d] == doctest::Approx(expected[d]).epsilon(1e-12));
      }
    }
  }

  TEST_CASE("It is empty unless asked for, 0 where no ray hits, and infinite for one ray") {
    const std::vector<Disc> discs{{{0, 0, 0}, {0, 0, 1}, 1}, {{5, 0, 0}, {0, 0, 1}, 1}};
    const std::vector<Ray> one{{{0, 0, 1}, {0, 0, -1}}};
    const std::vector<Ray> two{one.front(), one.front()};
    CHECK(run(make_problem(two, discs), box_tree).standard_error.empty());
    const Outcome outcome = run(make_problem(two, discs), box_tree, {.standard_error = true});
    CHECK(outcome.standard_error == std::vector<double>{0, 0});  // both rays hit the first disc
    const Outcome single = run(make_problem(one, discs), box_tree, {.standard_error = true});
    CHECK(std::isinf(single.standard_error[1]));
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

  TEST_CASE("A search of some of the rays, and a photon map, refuse it") {
    const std::vector<Disc> discs{{{0, 0, 0}, {0, 0, 1}, 1}};
    const std::vector<Ray> rays{{{0, 0, 1}, {0, 0, -1}, 1}};
    Totals totals;
    CHECK_THROWS_WITH_AS((void)run(make_problem(rays, discs), box_tree, {.standard_error = true, .totals = &totals}),
                         doctest::Contains("without totals"), std::invalid_argument);
    const Candidate photon_map{Technique::photon_map, PhotonMapParameters{3}};
    CHECK_THROWS_WITH_AS((void)run(make_problem(rays, discs), photon_map, {.standard_error = true}),
                         doctest::Contains("photon-map has no standard error"), std::invalid_argument);
  }
}
