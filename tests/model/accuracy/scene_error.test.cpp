#include "detp/model/accuracy/scene_error.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "detp/model/accuracy/estimate_error.hpp"

using namespace detp;
using namespace detp::model;

TEST_SUITE("identity") {
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

TEST_SUITE("bad input") {
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
