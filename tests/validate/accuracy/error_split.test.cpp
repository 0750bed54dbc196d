#include "detp/validate/accuracy/error_split.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "detp/sim/geometry/random.hpp"

namespace detp::validate {
namespace {

/// A normal number with mean 0 and variance 1.
double normal(std::uint64_t seed, std::uint64_t number, std::uint64_t purpose) {
  const auto uniform = sim::uniform4(seed, sim::Stream::tests, number, purpose);
  return std::sqrt(-2 * std::log1p(-uniform[0])) * std::cos(2 * std::numbers::pi * uniform[1]);
}

constexpr std::size_t samples = 400;

struct Made {
  std::vector<std::vector<double>> runs;
  std::vector<double> reference;
  std::vector<double> variance;

  [[nodiscard]] ReferenceValues values() const { return {reference, variance}; }
};

/// Irradiance 1 + i mod 3; runs with a standard deviation and a bias, a reference with a standard error.
Made made(std::size_t runs, double deviation, double bias, double reference_error, std::uint64_t seed) {
  Made all{.runs = std::vector<std::vector<double>>(runs, std::vector<double>(samples)),
           .reference = std::vector<double>(samples),
           .variance = std::vector<double>(samples, reference_error * reference_error)};
  for (std::size_t i = 0; i < samples; ++i) {
    const double truth = 1 + static_cast<double>(i % 3);
    all.reference[i] = truth + reference_error * normal(seed, i, 1000);
    for (std::size_t r = 0; r < runs; ++r) all.runs[r][i] = truth + bias + deviation * normal(seed, i, r);
  }
  return all;
}

const double rms = std::sqrt((134 * 1.0 + 133 * 4.0 + 133 * 9.0) / 400);

}  // namespace

TEST_SUITE("error split") {
  TEST_CASE("known answer by hand: two samples, three runs") {
    const std::vector<std::vector<double>> runs{{1, 5}, {2, 5}, {3, 5}};
    const std::vector<double> reference{1, 2};
    const std::vector<double> variance{0, 0.25};
    const ErrorSplit split = split_error(runs, {reference, variance});
    const double mean_square = (1 + 4 - 0.25) / 2;
    CHECK(split.noise_squared.mean == doctest::Approx((1.0 + 0) / 2 / mean_square));
    CHECK(split.bias_squared.mean == doctest::Approx((1 - 1.0 / 3 + 9 - 0.25) / 2 / mean_square));
    CHECK(split.total_squared.mean == doctest::Approx(split.noise_squared.mean + split.bias_squared.mean));
  }

  TEST_CASE("light at a sample without any is bias") {
    const std::vector<std::vector<double>> runs{{2, 1}, {2, 1}, {2, 1}};
    const std::vector<double> reference{2, 0};
    const std::vector<double> variance{0, 0};
    CHECK(split_error(runs, {reference, variance}).bias_squared.mean == doctest::Approx(0.25));
  }

  TEST_CASE("noise, bias and total come back without bias; intervals hold as often as they say" *
            doctest::description("400 made-up studies of each kind")) {
    for (const double bias : {0.0, 0.03, 0.3}) {
      CAPTURE(bias);
      constexpr int studies = 400;
      double noise = 0;
      double squared_bias = 0;
      int covered = 0;
      int total_covered = 0;
      const double deviation = 0.4;
      const double known = bias * bias / (rms * rms);
      const double known_noise = deviation * deviation / (rms * rms);
      double spread = 0;
      for (std::uint64_t study = 1; study <= studies; ++study) {
        const Made all = made(8, deviation, bias, 0.05, study);
        const ErrorSplit split = split_error(all.runs, all.values());
        noise += split.noise_squared.mean / studies;
        squared_bias += split.bias_squared.mean / studies;
        spread += std::pow(split.bias_squared.mean - known, 2) / studies;
        const double width = interval_width(0.05, 1, 8);
        covered += std::abs(split.bias_squared.mean - known) <= width * split.bias_squared.standard_error ? 1 : 0;
        total_covered +=
            std::abs(split.total_squared.mean - known - known_noise) <= width * split.total_squared.standard_error ? 1
                                                                                                                   : 0;
      }
      CHECK(noise == doctest::Approx(known_noise).epsilon(0.01));
      CHECK(std::abs(squared_bias - known) < 4 * std::sqrt(spread / studies));
      CHECK(covered >= 0.91 * studies);
      CHECK(total_covered >= 0.91 * studies);
    }
  }

  TEST_CASE("negative controls: the naive square of a mean's error contains noise, a reference's error is bias") {
    const Made all = made(8, 0.4, 0, 0, 1);
    double naive = 0;
    for (std::size_t i = 0; i < samples; ++i) {
      double mean = 0;
      for (const auto& run : all.runs) mean += run[i] / 8;
      naive += std::pow(mean - all.reference[i], 2) / (samples * rms * rms);
    }
    const ErrorSplit split = split_error(all.runs, all.values());
    CHECK(naive > 5 * split.bias_squared.standard_error);
    CHECK(std::abs(split.bias_squared.mean) < 4 * split.bias_squared.standard_error);

    const Made poor = made(8, 0.1, 0, 0.3, 1);
    const std::vector<double> forgotten(samples, 0.0);
    const ErrorSplit wrong = split_error(poor.runs, {poor.reference, forgotten});
    CHECK(wrong.bias_squared.mean > 10 * wrong.bias_squared.standard_error);
    const ErrorSplit right = split_error(poor.runs, poor.values());
    CHECK(std::abs(right.bias_squared.mean) < 4 * right.bias_squared.standard_error);
  }

  TEST_CASE("a root has an interval, and is 0 where the square is below 0") {
    const RootInterval root = root_of({0.04, 0.005}, 8);
    CHECK(root.value == doctest::Approx(0.2));
    CHECK(root.low == doctest::Approx(std::sqrt(0.04 - 2.3646 * 0.005)).epsilon(1e-4));
    CHECK(root.high == doctest::Approx(std::sqrt(0.04 + 2.3646 * 0.005)).epsilon(1e-4));
    const RootInterval none = root_of({-0.001, 0.002}, 8);
    CHECK(none.value == 0);
    CHECK(none.low == 0);
    CHECK(none.high > 0);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("few runs, other samples, numbers that are not finite and darkness are refused") {
    const std::vector<std::vector<double>> runs{{1, 5}, {2, 5}, {3, 5}};
    const std::vector<double> reference{1, 2};
    const std::vector<double> variance{0, 0};
    const auto refuses = [&](std::vector<std::vector<double>> of, const ReferenceValues& with, const char* why) {
      CHECK_THROWS_WITH_AS((void)split_error(of, with), doctest::Contains(why), std::invalid_argument);
    };
    refuses({runs[0], runs[1]}, {reference, variance}, "at least 3 runs (got 2)");
    refuses({runs[0], runs[1], {1}}, {reference, variance}, "same samples");
    refuses(runs, {reference, std::span(variance).first(1)}, "a variance for each");
    refuses({runs[0], runs[1], {1, std::numeric_limits<double>::quiet_NaN()}}, {reference, variance}, "finite");
    const std::vector<double> dark{0, 0};
    refuses(runs, {dark, variance}, "without light");
  }
}

}  // namespace detp::validate
