#include "detp/model/accuracy/nearest_photons.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "detp/sim/geometry/random.hpp"
#include "support/high_precision.hpp"
#include "support/not_a_length.hpp"

using namespace detp;
using namespace detp::model;

namespace {

constexpr double pi = std::numbers::pi;

/// Mean and variance of many estimates, with the standard errors of both.
class Sample {
 public:
  void add(double value) { values_.push_back(value); }
  [[nodiscard]] double mean() const { return moment(0, 1); }
  [[nodiscard]] double variance() const { return moment(mean(), 2); }
  [[nodiscard]] double error_of_mean() const { return std::sqrt(variance() / count()); }
  [[nodiscard]] double error_of_variance() const {
    return std::sqrt((moment(mean(), 4) - variance() * variance()) / count());
  }

 private:
  [[nodiscard]] double count() const { return static_cast<double>(values_.size()); }
  [[nodiscard]] double moment(double about, int power) const {
    double sum = 0;
    for (const double value : values_) sum += std::pow(value - about, power);
    return sum / count();
  }
  std::vector<double> values_;
};

/// The share of a uniform density within the distance of the k-th nearest of n photons. The share outside is the k-th
/// largest of n uniform numbers. It is a product of k factors, each distributed as the largest of n - i uniform
/// numbers.
double share_within(int n, int k, std::uint64_t seed, std::uint64_t replicate) {
  double outside = 0;
  for (int i = 0; i < k; ++i) {
    const double uniform = 1 - sim::uniform4(seed, sim::Stream::tests, replicate, static_cast<std::uint64_t>(i))[0];
    outside += std::log(uniform) / (n - i);
  }
  return -std::expm1(outside);
}

}  // namespace

TEST_SUITE("known answer") {
  // n photons on a plane with density 1 per area. Only the order of their distances matters.
  TEST_CASE("mean and variance counted in an even field are the exact ones, as is the bias of the plain estimate") {
    constexpr int replicates = 40'000;
    struct Case {
      int photons, nearest;
    };
    for (const Case& each : {Case{1000, 10}, Case{100, 30}, Case{100'000, 100}}) {
      const int photons = each.photons;  // no structured bindings: clang 14 does not let a lambda capture them
      const int nearest = each.nearest;
      CAPTURE(nearest);
      Sample unbiased;
      Sample plain;
      for (std::uint64_t i = 0; i < replicates; ++i) {
        const double area = share_within(photons, nearest, 61, i + 100'000 * static_cast<std::uint64_t>(nearest));
        unbiased.add((nearest - 1) / (photons * area));
        plain.add(nearest / (photons * area));
      }
      const DensityError expected = nearest_photons_error({.value = 1}, photons, nearest);
      const DensityError of_plain = plain_nearest_photons_error({.value = 1}, photons, nearest);
      CHECK(expected.bias == 0);
      CHECK(std::abs(unbiased.mean() - 1) < 4.5 * unbiased.error_of_mean());
      CHECK(std::abs(plain.mean() - 1 - of_plain.bias) < 4.5 * plain.error_of_mean());
      CHECK_MESSAGE(std::abs(plain.mean() - 1) > 10 * plain.error_of_mean(), "the plain one is not unbiased");
      CHECK(std::abs(unbiased.variance() - expected.variance) < 4.5 * unbiased.error_of_variance());
      CHECK(std::abs(plain.variance() - of_plain.variance) < 4.5 * plain.error_of_variance());
      CHECK_MESSAGE(std::abs(unbiased.variance() - 1.15 * expected.variance) > 4.5 * unbiased.error_of_variance(),
                    "15 % off must show");
    }
  }

  // Photons on the unit square with density 6 u (1 - u) along x, 1 along y: f = 3/2 and ∇²f = -12 at the middle.
  TEST_CASE("variance and bias on a parabolic density are those of the leading order") {
    constexpr int photons = 2000;
    constexpr int nearest = 200;
    Sample estimates;
    std::vector<double> squares(photons);
    for (std::uint64_t replicate = 0; replicate < 6000; ++replicate) {
      for (std::uint64_t i = 0; i < photons; ++i) {
        const auto u = sim::uniform4(62, sim::Stream::tests, replicate, i);
        // The median of three uniform numbers has the density 6 u (1 - u).
        const double x = std::max(std::min(u[0], u[1]), std::min(std::max(u[0], u[1]), u[2])) - 0.5;
        squares[i] = x * x + (u[3] - 0.5) * (u[3] - 0.5);
      }
      std::nth_element(squares.begin(), squares.begin() + nearest - 1, squares.end());
      estimates.add((nearest - 1) / (photons * pi * squares[nearest - 1]));
    }
    const DensityError expected = nearest_photons_error({.value = 1.5, .laplacian = -12}, photons, nearest);
    // The next order of the bias is k∇²f/(8πnf²) times the bias: 2 %.
    const double tolerance = 4 * estimates.error_of_mean() + 0.02 * std::abs(expected.bias);
    CHECK(std::abs(estimates.mean() - 1.5 - expected.bias) < tolerance);
    CHECK_MESSAGE(std::abs(estimates.mean() - 1.5 - 1.4 * expected.bias) > tolerance, "a bias 40 % off must show");
    // The curvature raises the variance by a share of k²(∇²f)²/(32π²n²f⁴): less than a thousandth.
    CHECK(std::abs(estimates.variance() - expected.variance) < 4.5 * estimates.error_of_variance());
    CHECK_MESSAGE(std::abs(estimates.variance() - 1.2 * expected.variance) > 4.5 * estimates.error_of_variance(),
                  "20 % off must show");
  }
}

TEST_SUITE("identity") {
  TEST_CASE("no other k has a smaller mean square error") {
    for (const double laplacian : {-1.0, 30.0, 2000.0, 1e6}) {
      const SmoothDensity density{.value = 2, .laplacian = laplacian};
      const double photons = 3000;
      const double best = best_nearest_photons(density, photons);
      CAPTURE(best);
      const double least = nearest_photons_error(density, photons, best).mean_square();
      for (double k = 3; k <= photons; ++k)
        CHECK(nearest_photons_error(density, photons, k).mean_square() >= least * (1 - 1e-13));
    }
    CHECK(best_nearest_photons({.value = 2, .laplacian = 0}, 3000) == 3000);
  }

  TEST_CASE("as many photons as an error needs give that error at their best k") {
    for (const double error : {0.3, 0.05, 0.002}) {
      const SmoothDensity density{.value = 40, .laplacian = 11e6};
      const double photons = std::round(photons_for_nearest_error(density, error));
      const double k = best_nearest_photons(density, photons);
      const double reached = std::sqrt(nearest_photons_error(density, photons, k).mean_square()) / density.value;
      // photons_for_nearest_error neglects p, about k/n. Rounding k to a whole number has only a second-order effect.
      CHECK(reached == doctest::Approx(error).epsilon(0.005 + k / photons));
    }
  }

  TEST_CASE("small errors need as many photons as with the disc, and 2/3 ε² more") {
    const SmoothDensity density{.value = 3, .laplacian = -7};
    for (const double error : {0.1, 0.01, 0.001}) {
      const double more = photons_for_nearest_error(density, error) / photons_for_error(density, error) - 1;
      CHECK(more == doctest::Approx(2.0 / 3 * error * error).epsilon(error * error));
    }
  }

  TEST_CASE("at equal mean count the disc has (k - 2)/k of the variance and k/(k - 1) of the bias") {
    const SmoothDensity density{.value = 3, .laplacian = -7};
    const double photons = 1e9;
    for (const double k : {3.0, 10.0, 1000.0}) {
      const DensityError nearest = nearest_photons_error(density, photons, k);
      const DensityError disc = density_error(density, photons, std::sqrt(k / (photons * pi * density.value)));
      CHECK(disc.variance / nearest.variance == doctest::Approx((k - 2) / k).epsilon(2e-6));
      CHECK(disc.bias / nearest.bias == doctest::Approx(k / (k - 1)).epsilon(1e-12));
    }
  }
}

TEST_SUITE("reference value") {
  TEST_CASE("agrees with 100-digit arithmetic, from 3 photons to 1e18") {
    using support::Exact;
    const Exact exact_pi = boost::math::constants::pi<Exact>();
    for (const double n : {3.0, 1e3, 1e9, 1e18})
      for (double k = 3; k <= n; k = std::floor(k * 37 + 1)) {
        const SmoothDensity density{.value = 0.3, .laplacian = -1e5};
        const DensityError error = nearest_photons_error(density, n, k);
        const Exact f = density.value;
        CHECK(support::relative_error(error.variance, f * f * (Exact{n} - k + 1) / n / (Exact{k} - 2)) < 1e-15);
        CHECK(support::relative_error(error.bias, (Exact{k} - 1) * density.laplacian / (8 * exact_pi * n * f)) < 1e-15);
      }
    for (const double error : {1e-8, 1e-3, 0.5, 1e3}) {
      const Exact square = Exact{error} * error;
      const Exact y = (3 + sqrt(9 + 8 * square)) / (4 * square);
      const Exact photons = 7 * y * sqrt(2 * (y + 1)) / (8 * exact_pi * Exact{0.3} * Exact{0.3});
      CHECK(support::relative_error(photons_for_nearest_error({0.3, 7}, error), photons) < 1e-15);
    }
  }

  TEST_CASE("the best k stays a whole number from 3 to n at the limits of the doubles") {
    for (const double f : {1e-300, 1.0, 1e300})
      for (const double laplacian : {5e-324, 1e-300, 1.0, 1e300})
        for (const double n : {3.0, 1e6, 1e18}) {
          const double k = best_nearest_photons({f, laplacian}, n);
          CHECK(k >= 3);
          CHECK(k <= n);
          CHECK(k == std::floor(k));
        }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("an invalid count, density or error is refused by name") {
    const SmoothDensity density{.value = 1, .laplacian = 1};
    using doctest::Contains;
    for (const double bad : support::not_a_length) {
      CHECK_THROWS_WITH_AS((void)nearest_photons_error({bad, 1}, 10, 3), Contains("density"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)nearest_photons_error(density, bad, 3), Contains("photons"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)best_nearest_photons(density, bad), Contains("photons"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)photons_for_nearest_error(density, bad), Contains("relative error"),
                           std::invalid_argument);
    }
    for (const double bad : {2.0, 3.5, 11.0})
      CHECK_THROWS_WITH_AS((void)plain_nearest_photons_error(density, 10, bad), Contains("photons looked for"),
                           std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)photons_for_nearest_error({1, 0}, 0.1), Contains("Laplacian"), std::invalid_argument);
  }
}
