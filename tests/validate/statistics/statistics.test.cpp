#include "detp/validate/statistics/statistics.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "detp/sim/geometry/random.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

/// The sum of 12 uniform numbers, minus 6. Its mean is 0, its standard deviation 1.
double nearly_normal(std::uint64_t seed, std::uint64_t index) {
  double sum = -6;
  for (std::uint64_t part = 0; part < 3; ++part)
    for (const double u : sim::uniform4(seed, sim::Stream::tests, index, part)) sum += u;
  return sum;
}

std::vector<double> batches_around(double mean, double sigma, std::uint64_t seed) {
  std::vector<double> batches;
  for (std::uint64_t i = 0; i < 32; ++i) batches.push_back(mean + sigma * nearly_normal(seed, i));
  return batches;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("the median of an even number of values is the mean of the middle two; quantiles interpolate") {
    CHECK(median({3, 1, 2}) == 2);
    CHECK(median({4, 1, 2, 3}) == 2.5);
    CHECK(median({7}) == 7);
    const std::vector<double> values{10, 0, 30, 20, 40};
    CHECK(quantile(values, 0) == 0);
    CHECK(quantile(values, 1) == 40);
    CHECK(quantile(values, 0.25) == 10);
    CHECK(quantile(values, 0.95) == doctest::Approx(38));
  }

  TEST_CASE("the median of ratios compares places, so what changes from place to place cancels; minima would not do") {
    const std::vector<double> fast_first{1, 2, 2, 2};
    const std::vector<double> slow_first{3.3, 1.65, 3.3, 3.3};
    CHECK(median_ratio(fast_first, fast_first) == 1);
    CHECK(median_ratio(slow_first, fast_first) == 1.65);
    CHECK(median_ratio(std::array{2.0, 9.0}, std::array{1.0, 3.0, 7.0}) == 2.5);  // places of both
    CHECK(std::isnan(median_ratio({}, fast_first)));
  }

  TEST_CASE("batch means 1, 2, 3, 4 have mean 5/2 and standard error sqrt(5/12)") {
    const Estimate estimate = batch_means(std::array{1.0, 2.0, 3.0, 4.0});
    CHECK(estimate.mean == 2.5);
    CHECK(estimate.standard_error == doctest::Approx(std::sqrt(5.0 / 12)).epsilon(1e-14));
  }

  TEST_CASE("a ratio of proportional batches has no error") {
    const Estimate ratio = batch_ratio(std::array{2.0, 4.0, 7.0}, std::array{1.0, 2.0, 3.5});
    CHECK(ratio.mean == 2);
    CHECK(ratio.standard_error < 1e-15);
  }

  TEST_CASE("the interval's width is Student's quantile: 2.0395 at 5 % and 31 degrees of freedom") {
    CHECK(interval_width(0.05, 1, 32) == doctest::Approx(2.0395134).epsilon(1e-7));
    CHECK(interval_width(0.05, 10, 32) == doctest::Approx(interval_width(0.005, 1, 32)).epsilon(1e-12));
  }

  TEST_CASE("the verdict is agrees inside the tolerance, refuted outside, undecided across its edge") {
    CHECK(judge(100, {101, 0.2}, 0.02, 3) == Verdict::agrees);
    CHECK(judge(100, {101, 0.4}, 0.02, 3) == Verdict::undecided);
    CHECK(judge(100, {103, 0.4}, 0.02, 3) == Verdict::undecided);
    CHECK(judge(100, {104, 0.4}, 0.02, 3) == Verdict::refuted);
    CHECK(judge(100, {96, 0.4}, 0.02, 3) == Verdict::refuted);
    CHECK(judge(10, {10, 0}, 0, 0) == Verdict::agrees);
    CHECK(judge(11, {10, 0}, 0, 0) == Verdict::refuted);
    CHECK(judge(-100, {-101, 0.2}, 0.02, 3) == Verdict::agrees);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("an empty set of values has no quantile, and a share below 0, above 1 or NaN is refused") {
    CHECK_THROWS_AS(static_cast<void>(median({})), std::invalid_argument);
    for (const double bad : {-0.1, 1.1, std::nan("")})
      CHECK_THROWS_AS(static_cast<void>(quantile({1, 2}, bad)), std::invalid_argument);
  }

  TEST_CASE("too few batches and invalid budgets are refused") {
    CHECK_THROWS_AS(static_cast<void>(batch_means(std::array{1.0})), std::invalid_argument);
    for (const double bad : {0.0, 1.0, -1.0, std::nan("")})
      CHECK_THROWS_AS(static_cast<void>(interval_width(bad, 1, 32)), std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(interval_width(0.01, 0, 32)), std::invalid_argument);
  }
}

TEST_SUITE("statistical") {
  // With 20 000 experiments, the binomial standard deviation of the share of misses is 0.0015.
  TEST_CASE("an interval of 95 % misses the truth in 5 % of experiments") {
    const double width = interval_width(0.05, 1, 32);
    int missed = 0;
    constexpr int experiments = 20'000;
    for (std::uint64_t seed = 0; seed < experiments; ++seed) {
      const Estimate estimate = batch_means(batches_around(3, 0.5, seed));
      missed += std::abs(estimate.mean - 3) > width * estimate.standard_error ? 1 : 0;
    }
    CHECK(std::abs(missed / static_cast<double>(experiments) - 0.05) < 0.0075);
  }

  TEST_CASE("wrong verdicts on true and false formulas are very rare; a detectable error is mostly refuted") {
    const double width = interval_width(0.01, 1, 32);
    int false_agreements = 0;
    int false_refutations = 0;
    int caught = 0;
    for (std::uint64_t seed = 0; seed < 5000; ++seed) {
      const Estimate estimate = batch_means(batches_around(100, 4, seed));
      false_agreements += judge(100 / 1.021, estimate, 0.02, width) == Verdict::agrees ? 1 : 0;
      false_refutations += judge(100 / 1.019, estimate, 0.02, width) == Verdict::refuted ? 1 : 0;
      const double detectable = detectable_deviation(100, {100, 4 / std::sqrt(32.0)}, 0.02, width);
      caught += judge(100 / (1 + detectable), estimate, 0.02, width) == Verdict::refuted ? 1 : 0;
    }
    CHECK(false_agreements <= 50);
    CHECK(false_refutations <= 50);
    CHECK(caught >= 4750);
  }
}
