#include "detp/model/accuracy/estimate_error.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "detp/model/accuracy/scene_error.hpp"
#include "detp/sim/geometry/predicates.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "support/not_a_length.hpp"

using namespace detp;
using namespace detp::model;

TEST_SUITE("identity") {
  TEST_CASE("as many rays as a deviation needs give that deviation") {
    for (const double deviation : {0.5, 0.1, 0.013}) {
      const double rays = std::round(rays_for_deviation(deviation, {0.1}, {1}));
      CHECK(uniform_field_deviation(rays, {0.1}, {1}) == doctest::Approx(deviation).epsilon(1e-3));
    }
  }

  TEST_CASE("no other radius has a smaller mean square error") {
    const SmoothDensity density{.value = 3, .laplacian = -7};
    const double best = best_density_radius(density, 1e5);
    const double least = density_error(density, 1e5, best).mean_square();
    for (double factor = 0.2; factor < 5; factor *= 1.01)
      CHECK(density_error(density, 1e5, factor * best).mean_square() >= least * (1 - 1e-14));
  }

  TEST_CASE("as many photons as an error needs give that error at their best radius") {
    for (const double error : {0.3, 0.05, 0.001}) {
      const SmoothDensity density{.value = 0.4, .laplacian = 11};
      const double photons = photons_for_error(density, error);
      const double radius = best_density_radius(density, photons);
      const double reached = std::sqrt(density_error(density, photons, radius).mean_square()) / density.value;
      CHECK(reached == doctest::Approx(error).epsilon(1e-12));
    }
  }

  TEST_CASE("even light: the noise of discs is that of one disc in a smooth density") {
    const SceneLight light{.mean = 3, .mean_square = 9};
    const double photon = 0.001;
    const DensityError one = density_error({.value = 3}, 1 / photon, 0.2);
    CHECK(disc_noise_squared(light, photon, 0.2) == doctest::Approx(one.variance / 9).epsilon(1e-14));
    CHECK(disc_noise_squared(light, photon, 0.2, 1.7) == doctest::Approx(1.7 * one.variance / 9).epsilon(1e-14));
  }

  TEST_CASE("triangle hits have the noise of discs of nine triangles' area") {
    const SceneLight light{.mean = 2, .mean_square = 5};
    CHECK(triangle_noise_squared(light, 0.01, std::numbers::pi / 9) ==
          doctest::Approx(disc_noise_squared(light, 0.01, 1)).epsilon(1e-14));
  }

  TEST_CASE("clumping is 1 without reflection; of many walls it counts all pieces but the next") {
    CHECK(room_clumping(0, 0.1, 6, 6) == 1);
    const double q = std::numbers::pi * 0.01 / 6;
    CHECK(room_clumping(0.5, 0.1, 6, 1e18) == doctest::Approx(1 + 2 * q * 0.25 / 0.5).epsilon(1e-14));
    // by the sum over pieces, of a cube
    double expected = 0;
    double on_the_wall = 0;
    for (int piece = 1; piece < 200; ++piece) {
      expected += std::pow(0.5, piece) * on_the_wall * 6 * q;
      on_the_wall = (1 - on_the_wall) / 5;
    }
    CHECK(room_clumping(0.5, 0.1, 6, 6) == doctest::Approx(1 + 2 * expected).epsilon(1e-13));
  }

  TEST_CASE("c₁ is the integral over the distance from the edge") {
    constexpr int steps = 100'000;
    double integral = 0;
    for (int i = 0; i < steps; ++i) {
      const double t = (i + 0.5) / steps;
      integral += std::pow((std::acos(t) - t * std::sqrt(1 - t * t)) / std::numbers::pi, 2) / steps;
    }
    CHECK(bias_of_edges(1, 1) == doctest::Approx(integral).epsilon(1e-8));
    CHECK(bias_of_edges(3, 2) == doctest::Approx(1.5 * integral).epsilon(1e-8));
  }

  TEST_CASE("the terms of the bias add up: slope 1 near small radii, 4 near large ones") {
    const BiasTerms terms{.constant = 0.01, .linear = 2, .fourth = 3};
    CHECK(bias_squared(terms, 0.5) == doctest::Approx(0.01 + 1 + 3.0 / 16).epsilon(1e-15));
    const BiasTerms no_edges{.fourth = 3};
    CHECK(bias_squared(no_edges, 0.2) / bias_squared(no_edges, 0.1) == doctest::Approx(16).epsilon(1e-14));
    CHECK(bias_of_samples_on_edges(0.4) == doctest::Approx(0.1));
    // A parabola E = 1 + κ r²/2 with ∇²E = 2κ has the bias κ d²/4.
    const double curvature = 0.3;
    const double fourth = bias_of_curvature({.mean = 1, .mean_square = 1}, std::pow(2 * curvature, 2));
    CHECK(fourth == doctest::Approx(std::pow(curvature / 4, 2)).epsilon(1e-14));
  }
}

TEST_SUITE("known answer") {
  // A standard deviation counted on 4000 replicates has a relative standard error of 1/√8000 = 1.1 %.
  TEST_CASE("the deviation over replicates of a uniform field is the binomial one") {
    constexpr int replicates = 4000;
    constexpr std::uint64_t rays = 500;
    const sim::Disc disc{{0.1, 0.2, -0.3}, {0, 0, 1}, 0.3};
    const sim::LineField field({}, 3);
    double sum = 0;
    double squares = 0;
    for (std::uint64_t replicate = 0; replicate < replicates; ++replicate) {
      double hits = 0;
      for (std::uint64_t i = 0; i < rays; ++i) hits += sim::hits(field.line(replicate * rays + i), disc) ? 1 : 0;
      sum += hits;
      squares += hits * hits;
    }
    const double mean = sum / replicates;
    const double deviation = std::sqrt(squares / replicates - mean * mean) / mean;
    const double expected = uniform_field_deviation(rays, {0.3}, {1});
    CHECK(std::abs(deviation / expected - 1) < 0.055);
    CHECK_MESSAGE(std::abs(deviation / (1.12 * expected) - 1) > 0.055, "12 % off must show");
  }

  // Photons on the unit square with density 6 u (1 - u) along x, 1 along y: f = 3/2 and ∇²f = -12 at the middle.
  TEST_CASE("variance and bias on a parabolic density are those of the leading order") {
    constexpr int replicates = 12000;
    constexpr int photons = 2000;
    constexpr double radius = 0.15;
    double sum = 0;
    double squares = 0;
    for (std::uint64_t replicate = 0; replicate < replicates; ++replicate) {
      int inside = 0;
      for (std::uint64_t i = 0; i < photons; ++i) {
        const auto u = sim::uniform4(5, sim::Stream::tests, replicate, i);
        // The median of three uniform numbers has the density 6 u (1 - u).
        const double x = std::max(std::min(u[0], u[1]), std::min(std::max(u[0], u[1]), u[2])) - 0.5;
        const double y = u[3] - 0.5;
        inside += x * x + y * y <= radius * radius ? 1 : 0;
      }
      const double estimate = inside / (photons * std::numbers::pi * radius * radius);
      sum += estimate;
      squares += estimate * estimate;
    }
    const double mean = sum / replicates;
    const double variance = squares / replicates - mean * mean;
    const DensityError expected = density_error({.value = 1.5, .laplacian = -12}, photons, radius);
    const double error_of_mean = std::sqrt(variance / replicates);
    CHECK(std::abs(mean - 1.5 - expected.bias) < 5 * error_of_mean);
    CHECK_MESSAGE(std::abs(mean - 1.5 - 1.25 * expected.bias) > 5 * error_of_mean, "a bias 25 % off must show");
    // The leading order omits the binomial factor 1 - p, about 0.9 here. The count has a standard error of 1.3 %.
    CHECK(std::abs(variance / expected.variance - 0.9) < 0.08);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("an invalid count, length, density or error is refused by name") {
    const SmoothDensity density{.value = 1, .laplacian = 1};
    using doctest::Contains;
    for (const double bad : support::not_a_length) {
      CHECK_THROWS_WITH_AS((void)rays_for_deviation(bad, {0.1}, {1}), Contains("deviation"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)density_error(density, 10, bad), Contains("disc radius"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)density_error(density, bad, 1), Contains("photons"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)photons_for_error(density, bad), Contains("relative error"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)best_density_radius({bad, 1}, 10), Contains("density"), std::invalid_argument);
    }
    CHECK_THROWS_WITH_AS((void)best_density_radius({1, 0}, 10), Contains("Laplacian"), std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)uniform_field_deviation(0.5, {0.1}, {1}), Contains("rays"), std::invalid_argument);
    CHECK_THROWS_AS((void)uniform_field_deviation(10, {2}, {1}), std::invalid_argument);
  }

  TEST_CASE("arguments out of range are refused with their value") {
    const SceneLight light{};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS((void)disc_noise_squared({.mean = 0}, 1, 1), doctest::Contains("mean irradiance"),
                         std::invalid_argument);
    CHECK_THROWS_AS((void)disc_noise_squared(light, nan, 1), std::invalid_argument);
    CHECK_THROWS_AS((void)disc_noise_squared(light, 1, -1), std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)disc_noise_squared(light, 1, 1, 0.5), doctest::Contains("at least 1 (got 0.5)"),
                         std::invalid_argument);
    CHECK_THROWS_AS((void)triangle_noise_squared(light, 1, 0), std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)room_clumping(1, 0.1, 6, 6), doctest::Contains("below 1 (got 1)"),
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)room_clumping(0.5, 2, 6, 6), doctest::Contains("larger than the room"),
                         std::invalid_argument);
    CHECK_THROWS_AS((void)room_clumping(0.5, 0.1, 6, 1), std::invalid_argument);
    CHECK_THROWS_AS((void)bias_squared({.linear = -1}, 1), std::invalid_argument);
    CHECK_THROWS_AS((void)bias_of_samples_on_edges(1.1), std::invalid_argument);
    CHECK_THROWS_AS((void)bias_of_edges(-1, 1), std::invalid_argument);
    CHECK_THROWS_AS((void)bias_of_curvature(light, nan), std::invalid_argument);
  }
}
