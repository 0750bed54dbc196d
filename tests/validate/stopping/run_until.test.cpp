#include "detp/validate/stopping/run_until.hpp"

#include <doctest/doctest.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "detp/sim/base/stopped.hpp"

namespace detp::validate {
namespace {

/// Photons that bring light to discs: each meets one group of discs, or none.
struct Light {
  std::size_t discs = 1;
  std::size_t group = 1;   ///< discs that a photon meets together
  double hit = 1;          ///< probability that a photon meets a group
  double spread = 0;       ///< standard deviation of the logarithm of its power
  std::size_t pieces = 1;  ///< times that it meets the group
  std::mt19937_64 random{1};

  [[nodiscard]] double truth() const {
    return hit * static_cast<double>(group * pieces) / static_cast<double>(discs) * std::exp(0.5 * spread * spread);
  }
  /// Relative variance of the irradiance of a disc from one photon.
  [[nodiscard]] double variance_of_photon() const {
    return std::exp(spread * spread) / (hit * static_cast<double>(group) / static_cast<double>(discs)) - 1;
  }

  Batch batch(std::uint64_t photons) {
    Batch made{std::vector<double>(discs), static_cast<double>(photons), photons};
    std::uniform_real_distribution<double> uniform;
    std::normal_distribution<double> normal;
    for (std::uint64_t i = 0; i < photons; ++i) {
      if (uniform(random) >= hit) continue;
      const std::size_t which = random() % (discs / group);
      const double power =
          static_cast<double>(pieces) * std::exp(spread * normal(random)) / static_cast<double>(photons);
      for (std::size_t disc = 0; disc < group; ++disc) made.irradiance[which * group + disc] += power;
    }
    return made;
  }
};

std::vector<double> equal(std::size_t discs) { return std::vector<double>(discs, 1 / static_cast<double>(discs)); }

double error_of(const std::vector<double>& found, double truth) {
  double square = 0;
  for (const double one : found) square += (one - truth) * (one - truth) / static_cast<double>(found.size());
  return std::sqrt(square) / truth;
}

struct Coverage {
  int kept = 0;                   ///< runs whose error is below the target
  int inside = 0;                 ///< runs whose error is in the interval
  int inside_if_independent = 0;  ///< runs whose error is below the bound for discs that share no photons
  std::vector<double> photons;
};

NextBatch batches_of(Light& light) {
  return [&light](std::uint64_t rays, std::uint64_t) { return std::optional(light.batch(rays)); };
}

Coverage coverage(Light light, double target, int runs) {
  Coverage found;
  for (int run = 0; run < runs; ++run) {
    const UntilResult result =
        run_until(batches_of(light), equal(light.discs), {.error = target}, {.first_rays = 3200});
    CHECK(result.reason == StopReason::target);
    const double error = error_of(result.irradiance, light.truth());
    found.kept += error <= target ? 1 : 0;
    found.inside += error >= result.noise.low && error <= result.noise.high ? 1 : 0;
    const auto discs = static_cast<double>(light.discs);
    const double bound = std::sqrt(quantile(boost::math::chi_squared(discs), 0.95) / discs);
    found.inside_if_independent += error <= bound * result.noise.value ? 1 : 0;
    found.photons.push_back(result.photons);
  }
  return found;
}

/// Looks after every pair of batches, and takes the noise for known.
int kept_by_naive_rule(Light light, double target, int runs) {
  int kept = 0;
  for (int run = 0; run < runs; ++run) {
    PairedBatches batches(equal(light.discs));
    do
      for (int one = 0; one < 2; ++one) batches.add(light.batch(50).irradiance, 50);
    while (!(batches.noise(0.95).value <= target));
    kept += error_of(batches.irradiance(), light.truth()) <= target ? 1 : 0;
  }
  return kept;
}

/// A run that is stopped after each stretch of batches, looked at, and gone on with until it says that the target is reached.
UntilResult stopped_often(Light& light, double target, int stretch) {
  int left = 0;
  const NextBatch next = [&](std::uint64_t rays, std::uint64_t) {
    if (left-- == 0) throw sim::Stopped("stopped");
    return std::optional(light.batch(rays));
  };
  UntilOptions options{.first_rays = 3200};
  UntilState state;
  options.save = [&](const std::function<UntilState()>& now) { state = now(); };
  while (true) {
    left = stretch;
    UntilResult result = run_until(next, equal(light.discs), {.error = target}, options);
    if (result.reason != StopReason::time) return result;
    options.resume = state;
  }
}

}  // namespace

TEST_SUITE("statistical") {
  TEST_CASE("a run that is stopped and gone on with often errs as seldom as one that is not") {
    Light light{.discs = 1, .hit = 0.1, .spread = 1, .random = std::mt19937_64{3}};
    constexpr int runs = 400;
    int kept = 0;
    int stops = 0;
    for (int run = 0; run < runs; ++run) {
      const UntilResult result = stopped_often(light, 0.1, 1);
      kept += error_of(result.irradiance, light.truth()) <= 0.1 ? 1 : 0;
      stops += result.stops;
    }
    CHECK(stops > 40 * runs);
    CHECK(kept >= 366);  // of a binomial 0.95, less happens in 0.1 %
  }

  TEST_CASE("the error at the end is below the target in 95 % of the runs, and the naive rule's is not") {
    constexpr int runs = 200;
    constexpr int least = 182;  // of a binomial 0.95, less happens in 0.1 %
    for (const auto& one :
         std::vector<std::pair<Light, double>>{{{.discs = 1, .hit = 0.1, .spread = 1}, 0.05},
                                               {{.discs = 1, .hit = 0.01}, 0.1},
                                               {{.discs = 100, .hit = 0.5, .spread = 1}, 0.1},
                                               {{.discs = 100, .group = 50, .hit = 0.5, .spread = 1}, 0.05},
                                               {{.discs = 1000, .hit = 0.5}, 0.1},
                                               {{.discs = 10, .hit = 0.1, .spread = 1.5, .pieces = 7}, 0.1}}) {
      const Light& light = one.first;
      const double target = one.second;
      INFO("light.discs ", light.discs, ", light.group ", light.group, ", light.hit ", light.hit);
      const Coverage found = coverage(light, target, runs);
      CHECK(found.kept >= least);
      CHECK(found.inside >= 170);  // both ends: 90 %
      CHECK(kept_by_naive_rule(light, target, runs) < 160);
      if (light.group > 1) CHECK(found.inside_if_independent < 170);
      // The least fixed number of photons whose error is below the target in 95 % of the runs, if it were known.
      const auto independent = static_cast<double>(light.discs / light.group);
      const double fixed = light.variance_of_photon() / (target * target) *
                           quantile(boost::math::chi_squared(independent), 0.95) / independent;
      CHECK(median(found.photons) <= (independent < 50 ? 2 : 1.25) * fixed);
    }
  }
}

TEST_SUITE("stopping") {
  TEST_CASE("the interval of one disc and many photons in a batch is that of Student's t") {
    PairedBatches batches({1.0});
    const double differences[] = {1, -2, 0.5, 1.5, -1, 0.2};
    for (const double difference : differences) {
      batches.add(std::vector{10 + difference / 2}, 100);
      batches.add(std::vector{10 - difference / 2}, 100);
    }
    double squares = 0;
    for (const double difference : differences) squares += difference * difference;
    // The variance of the mean of 12 batches: that of a batch is the mean of difference²/2.
    const double variance = squares / 6 / 2 / 12;
    CHECK(batches.noise(0.95).value == doctest::Approx(std::sqrt(variance / (100 - variance))).epsilon(1e-12));
    CHECK(batches.mean_square() == doctest::Approx(100 - variance).epsilon(1e-12));
    // Unequal batches of one pair count by their photons.
    PairedBatches unequal({1.0});
    for (int pair = 0; pair < 2; ++pair) {
      unequal.add(std::vector{9.0}, 100);
      unequal.add(std::vector{12.0}, 300);
    }
    const double of_photon = 9.0 * 100 * 300 / 400;
    CHECK(unequal.irradiance()[0] == doctest::Approx(11.25));
    CHECK(std::pow(unequal.noise(0.9).value, 2) * unequal.mean_square() == doctest::Approx(of_photon / 800));
  }

  TEST_CASE("a run ends after any stage, the first one too; a bias, the end of the rays and a stop end it") {
    Light light{.discs = 4, .hit = 0.5, .random = std::mt19937_64{7}};
    const UntilResult easy = run_until(batches_of(light), equal(4), {.error = 0.5}, {.first_rays = 3200});
    CHECK(easy.reason == StopReason::target);
    CHECK(easy.tests == 0);
    CHECK(easy.looks == 1);
    CHECK(easy.rays == 3200);
    CHECK(easy.noise.high <= 0.5);
    const UntilResult later = run_until(batches_of(light), equal(4), {.error = 0.02}, {.first_rays = 3200});
    CHECK(later.reason == StopReason::target);
    CHECK(later.tests >= 1);
    // Whatever is printed does not contradict the reason: also if the rays end in the first stage.
    const UntilResult only =
        run_until(batches_of(light), equal(4), {.error = 0.5}, {.most_rays = 3000, .first_rays = 3200});
    CHECK(only.reason == StopReason::target);
    const UntilResult not_reached =
        run_until(batches_of(light), equal(4), {.error = 1e-3}, {.most_rays = 3000, .first_rays = 3200});
    CHECK(not_reached.reason == StopReason::rays);
    CHECK(not_reached.noise.high > 1e-3);
    const UntilResult biased = run_until(batches_of(light), equal(4),
                                         {.error = 0.05, .bias_squared = Estimate{0.0024, 1e-4}}, {.first_rays = 3200});
    CHECK(biased.reason == StopReason::bias);
    CHECK(biased.rays == 3200);
    const UntilResult total = run_until(batches_of(light), equal(4),
                                        {.error = 0.05, .bias_squared = Estimate{0.0016, 1e-4}}, {.first_rays = 3200});
    CHECK(total.reason == StopReason::target);
    CHECK(total.noise.high <= 0.03);
    CHECK(with_bias(total.noise, {0.0016, 1e-4}).value <= 0.05);
    const UntilResult limited =
        run_until(batches_of(light), equal(4), {.error = 0.001}, {.most_rays = 20'000, .first_rays = 3200});
    CHECK(limited.reason == StopReason::rays);
    CHECK(limited.rays >= 20'000);
    CHECK(limited.rays < 20'100);
    int batches = 0;
    const NextBatch stopped = [&](std::uint64_t rays, std::uint64_t) -> std::optional<Batch> {
      if (++batches > 40) throw sim::Stopped("stopped");
      return light.batch(rays);
    };
    const UntilResult partial = run_until(stopped, equal(4), {.error = 0.001}, {.first_rays = 3200});
    CHECK(partial.reason == StopReason::time);
    batches = 0;
    CHECK(run_until(stopped, equal(4), {.error = 0.1}, {.first_rays = 64'000}).reason == StopReason::target);
    CHECK(partial.noise.value > 0);
    CHECK(partial.rays > 3200);
    const NextBatch few = [&](std::uint64_t rays, std::uint64_t) {
      return ++batches % 50 == 0 ? std::nullopt : std::optional(light.batch(rays));
    };
    CHECK(run_until(few, equal(4), {.error = 0.001}, {.first_rays = 3200}).reason == StopReason::rays);
  }

  TEST_CASE("a run that goes on from any of its states ends as in one go") {
    unsigned made = 0;
    const NextBatch next = [&](std::uint64_t rays, std::uint64_t) {
      return std::optional(Light{.discs = 3, .hit = 0.2, .spread = 1, .random = std::mt19937_64(++made)}.batch(rays));
    };
    std::vector<UntilState> states;
    UntilOptions options{.first_rays = 3200};
    options.save = [&](const std::function<UntilState()>& state) { states.push_back(state()); };
    const UntilResult whole = run_until(next, equal(3), {.error = 0.1}, options);
    REQUIRE(states.size() > 60);
    for (const std::size_t last :
         {std::size_t{0}, std::size_t{10}, std::size_t{31}, std::size_t{32}, states.size() - 1}) {
      CAPTURE(last);
      made = static_cast<unsigned>(last) + 1;
      const UntilResult again = run_until(next, equal(3), {.error = 0.1}, {.first_rays = 3200, .resume = states[last]});
      CHECK(again.irradiance == whole.irradiance);
      CHECK(again.rays == whole.rays);
      CHECK(again.tests == whole.tests);
      CHECK(again.noise.high == whole.noise.high);
    }
    CHECK_THROWS_AS(static_cast<void>(run_until(next, equal(4), {}, {.resume = states[40]})), std::invalid_argument);
  }

  TEST_CASE("where no photon meets a disc, there is a bound and no noise") {
    Light dark{.discs = 3, .hit = 0};
    const UntilResult result = run_until(batches_of(dark), equal(3), {}, {.most_rays = 50'000, .first_rays = 3200});
    CHECK(result.reason == StopReason::rays);
    CHECK(std::isinf(result.noise.high));
    REQUIRE(result.share_bound);
    CHECK(*result.share_bound == doctest::Approx(-std::log(0.05) / result.photons));
  }

  TEST_CASE("the noise of extreme irradiance is that of ordinary one") {
    const auto noise_of = [](int exponent) {
      PairedBatches batches(equal(3));
      batches.add(std::vector{0.0, 0.0, 0.0}, 10);  // no light yet
      for (int i = 1; i < 20; ++i)
        batches.add(
            std::vector{std::ldexp(1 + i % 3, exponent), std::ldexp(2 - i % 2, exponent), std::ldexp(0.5, exponent)},
            10 + i);
      CHECK(std::ilogb(batches.irradiance()[0]) == exponent);
      return batches.noise(0.95);
    };
    const NoiseInterval usual = noise_of(0);
    CHECK(std::isfinite(usual.high));
    for (const int exponent : {-1000, -660, -300, 100, 300, 660, 1000}) {
      const NoiseInterval extreme = noise_of(exponent);
      CHECK(extreme.value == usual.value);
      CHECK(extreme.low == usual.low);
      CHECK(extreme.high == usual.high);
    }
  }

  TEST_CASE("bad targets, weights and batches are refused") {
    Light light{.discs = 2};
    for (const double wrong : {0.0, 1.0, -0.1, std::numeric_limits<double>::quiet_NaN()}) {
      CHECK_THROWS_AS(static_cast<void>(run_until(batches_of(light), equal(2), {.error = wrong})),
                      std::invalid_argument);
      CHECK_THROWS_AS(static_cast<void>(run_until(batches_of(light), equal(2), {.confidence = wrong})),
                      std::invalid_argument);
    }
    CHECK_THROWS_AS(static_cast<void>(run_until(batches_of(light), equal(3), {})), std::invalid_argument);
    CHECK_THROWS_AS(PairedBatches({0.5, 0.6}), std::invalid_argument);
    CHECK_THROWS_AS(PairedBatches({1.5, -0.5}), std::invalid_argument);
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinite = std::numeric_limits<double>::infinity();
    for (const double wrong : {0.0, -5.0, nan, infinite})
      CHECK_THROWS_AS(PairedBatches({1.0}).add(std::vector{1.0}, wrong), std::invalid_argument);
    for (const double wrong : {nan, infinite})
      CHECK_THROWS_AS(PairedBatches({1.0}).add(std::vector{wrong}, 1), std::invalid_argument);
    for (const double wrong : {0.0, -4.0, nan, infinite})
      CHECK_THROWS_AS(static_cast<void>(run_until(batches_of(light), equal(2), {}, {.most_rays = wrong})),
                      std::invalid_argument);
  }
}

}  // namespace detp::validate
