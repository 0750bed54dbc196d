#include "detp/model/sphere_cache/rebuild_law.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "support/not_a_length.hpp"
#include "support/random_workload.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Approx;
using doctest::Contains;

namespace {

const Workload in_volume = cube_workload(1e6, 1e6, 0.001, 2);
const Workload on_faces = cube_workload(1e6, 1e6, 0.001, 2, 2);

/// m/n of a single ball that is so small that the cube's faces do not affect it.
double small_ball_share(double dimension, double lambda, double phase) {
  return single_rebuilds(dimension, 1e300, {lambda, 20 + phase}) / 1e300;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("with more samples a ball, the share of samples that start a new ball never grows") {
    for (const double dimension : {1.0, 2.0, 2.4, 3.0})
      for (double phase = 0; phase <= 1; phase += 1.0 / 32) {
        double before = 1;
        for (double log_lambda = -30; log_lambda < 40; log_lambda += 0.1) {
          const double share = small_ball_share(dimension, std::exp2(log_lambda), phase);
          REQUIRE(share <= before);
          REQUIRE(share > 0);
          before = share;
        }
      }
  }

  TEST_CASE("with ever fewer samples a ball, each starts one; the rest is proportional to the samples a ball") {
    for (const double dimension : {2.0, 3.0}) {
      CHECK(small_ball_share(dimension, 0, 0.3) == 1);
      CHECK(small_ball_share(dimension, 1e-300, 0.3) == 1);
      const double rest = 1 - small_ball_share(dimension, 1e-6, 0.3);
      CHECK(rest > 0);
      CHECK(1 - small_ball_share(dimension, 1e-5, 0.3) == Approx(10 * rest).epsilon(1e-3));
    }
  }

  TEST_CASE("with many samples a ball, the number of balls does not depend on that of the samples") {
    for (const double dimension : {2.0, 2.5, 3.0})
      for (const double phase : {0.0, 0.4, 0.9})
        CHECK(1e9 * small_ball_share(dimension, 1e9, phase) ==
              Approx(1e5 * small_ball_share(dimension, 1e5, phase)).epsilon(1e-12));
  }

  TEST_CASE("the share is continuous in the number of samples and in the phase, also where the phase wraps") {
    support::RandomNumbers random(3);
    for (int run = 0; run < 2000; ++run) {
      const double dimension = random.uniform(2, 3);
      const double lambda = random.log_uniform(1e-5, 1e6);
      const double phase = random.uniform(0, 0.999);
      const double share = small_ball_share(dimension, lambda, phase);
      REQUIRE(small_ball_share(dimension, lambda, phase + 1e-6) == Approx(share).epsilon(1e-5));
      REQUIRE(small_ball_share(dimension, lambda * (1 + 1e-6), phase) == Approx(share).epsilon(1e-5));
      REQUIRE(small_ball_share(dimension, lambda, 0) == small_ball_share(dimension, lambda, 1));
    }
  }

  TEST_CASE("between surfaces and volumes the share lies between theirs; below 2 it is that of surfaces") {
    support::RandomNumbers random(4);
    for (int run = 0; run < 2000; ++run) {
      const double lambda = random.log_uniform(1e-5, 1e6);
      const double phase = random.uniform(0, 1);
      const double surface = small_ball_share(2, lambda, phase);
      const double volume = small_ball_share(3, lambda, phase);
      const double between = small_ball_share(random.uniform(2, 3), lambda, phase);
      REQUIRE(between >= std::min(surface, volume) * (1 - 1e-14));
      REQUIRE(between <= std::max(surface, volume) * (1 + 1e-14));
      REQUIRE(small_ball_share(1.3, lambda, phase) == surface);
    }
  }

  TEST_CASE("rebuilds of a ball alone: one per sample for no ball, one for a ball around all, falling between") {
    for (const auto order : {SampleOrder::lebesgue, SampleOrder::none})
      for (const Workload& w : {in_volume, on_faces}) {
        CHECK(single_rebuilds(w, 0, order) == w.samples);
        CHECK(single_rebuilds(w, -0.1, order) == w.samples);
        CHECK(single_rebuilds(w, 1e-9, order) == Approx(w.samples).epsilon(1e-9));
        CHECK(single_rebuilds(w, 100, order) == 1);
        for (double radius = 1e-5; radius < 5; radius *= 1.1) {
          const double rebuilds = single_rebuilds(w, radius, order);
          CHECK(rebuilds >= 1);
          CHECK(rebuilds <= w.samples);
        }
      }
  }

  TEST_CASE("sorting saves rebuilds") {
    for (const Workload& w : {in_volume, on_faces})
      for (double radius = 0.01; radius < 0.5; radius *= 1.3)
        CHECK(single_rebuilds(w, radius, SampleOrder::lebesgue) < single_rebuilds(w, radius, SampleOrder::none));
  }

  TEST_CASE("rebuilds do not depend on the unit of length") {
    for (double scale : {1e-9, 1e9}) {
      const Workload scaled = cube_workload(1e6, 1e6, 0.001 * scale, 2 * scale, 2);
      for (const auto order : {SampleOrder::lebesgue, SampleOrder::none})
        for (const double radius : {0.01, 0.13, 0.9})
          CHECK(single_rebuilds(scaled, radius * scale, order) ==
                Approx(single_rebuilds(on_faces, radius, order)).epsilon(1e-9));
    }
  }

  TEST_CASE("a nested sphere: at least the rebuilds around it, at most those plus its own, at most the samples") {
    support::RandomNumbers random(6);
    for (int run = 0; run < 5000; ++run) {
      const double samples = random.count(1, 1e9);
      const double alone = random.log_uniform(1, samples + 1e-9);
      const double outer = random.log_uniform(1, samples + 1e-9);
      const double share = random.uniform(0, 1);
      const double nested = nested_rebuilds(alone, outer, share, samples);
      REQUIRE(nested >= std::min(outer, samples));
      REQUIRE(nested <= samples);
      REQUIRE(nested <= outer + share * alone);
      REQUIRE(nested_rebuilds(alone, 0, 1, samples) == std::min(alone, samples));
    }
    CHECK(nested_rebuilds(1000, 10, 1, 1000) == 1000);
    CHECK(nested_rebuilds(100, 50, 0.5, 1e15) == Approx(100).epsilon(1e-9));
  }

  TEST_CASE("a ball keeps all its own rebuilds if none are around it, and fewer the more are around it") {
    support::RandomNumbers random(8);
    for (int run = 0; run < 5000; ++run) {
      const double dimension = random.uniform(1, 3);
      const Ball ball{random.log_uniform(1e-3, 1e6), random.uniform(-1, 20)};
      const double octaves = random.uniform(0.0625, 3);
      const double crowding = random.log_uniform(1e-3, 10);
      const double share = own_rebuild_share(dimension, ball, octaves, crowding);
      REQUIRE(own_rebuild_share(dimension, ball, octaves, 0) == 1);
      REQUIRE(share <= 1);
      REQUIRE(share > 0);
      REQUIRE(own_rebuild_share(dimension, ball, octaves, 2 * crowding) <= share);
    }
  }

  TEST_CASE("the remaining share is continuous in ball and ratio, and lies between those of whole dimensions") {
    support::RandomNumbers random(9);
    for (int run = 0; run < 5000; ++run) {
      const Ball ball{random.log_uniform(1e-3, 1e6), random.uniform(-1, 20)};
      const double octaves = random.uniform(0.07, 3);
      const double crowding = random.uniform(0, 3);
      const double surface = own_rebuild_share(2, ball, octaves, crowding);
      const double volume = own_rebuild_share(3, ball, octaves, crowding);
      REQUIRE(own_rebuild_share(3, ball, octaves + 1e-9, crowding) == Approx(volume).epsilon(1e-6));
      REQUIRE(own_rebuild_share(3, {ball.lambda * (1 + 1e-9), ball.halvings}, octaves, crowding) ==
              Approx(volume).epsilon(1e-6));
      REQUIRE(own_rebuild_share(3, {ball.lambda, ball.halvings + 1e-9}, octaves, crowding) ==
              Approx(volume).epsilon(1e-5));
      const double between = own_rebuild_share(2.5, ball, octaves, crowding);
      REQUIRE(between >= std::min(surface, volume) * (1 - 1e-14));
      REQUIRE(between <= std::max(surface, volume) * (1 + 1e-14));
      REQUIRE(own_rebuild_share(1.5, ball, octaves, crowding) == surface);
    }
  }

  TEST_CASE("with ever more spheres, the own rebuilds of each are proportional to the step between spheres") {
    for (const double dimension : {2.0, 3.0})
      for (const double lambda : {0.1, 10.0, 1e5}) {
        const double share = own_rebuild_share(dimension, {lambda, 5.3}, 1e-9, 2);
        CHECK(share > 0);
        CHECK(own_rebuild_share(dimension, {lambda, 5.3}, 1e-10, 2) == Approx(share / 10).epsilon(1e-6));
        CHECK(own_rebuild_share(dimension, {lambda, 5.3}, 0, 2) == 0);
      }
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("samples in a volume: m/n agrees with counts on Morton runs of balls") {
    const double lambda[] = {0.022, 0.18, 0.85, 2.4, 11, 32, 92, 259, 732};
    const double counted[] = {0.97, 0.84, 0.60, 0.42, 0.15, 0.083, 0.042, 0.012, 0.009};
    const double half_a_digit[] = {0.005, 0.005, 0.005, 0.005, 0.005, 0.0005, 0.0005, 0.0005, 0.0005};
    for (int i = 0; i < 9; ++i) {
      CAPTURE(lambda[i]);
      double least = 1;
      double most = 0;
      for (int phase = 0; phase <= 32; ++phase) {
        const double share = small_ball_share(3, lambda[i], phase / 32.0);
        least = std::min(least, share);
        most = std::max(most, share);
      }
      CHECK(counted[i] + half_a_digit[i] > least);  // counted at one phase and rounded
      CHECK(counted[i] - half_a_digit[i] < most);
    }
  }

  TEST_CASE("large balls between the table's entries: m_1 agrees with counts over other sets of samples") {
    // The deviation is at most 2 %, except for two rows with D = 3. For the number of samples of these rows the table
    // has no column, and m jumps between the two nearest columns.
    struct Counted {
      double dimension, samples, disc, ratio, rebuilds;  // in a cube of side 2; noise 0.1 to 1.9 %
      double within = 0.02;                              // the noise and the table's own error of 1 %
    };
    for (const Counted& counted :
         {Counted{3, 30'000, 0.015, 0.62, 55.9}, Counted{2, 1898, 0.05516789, 0.77059285, 23.25},
          Counted{3, 173'075, 0.00111974, 0.64684837, 53.18, 0.056}, Counted{2, 2161, 0.002440997, 0.76880349, 22.75},
          Counted{3, 19'672, 0.01205304, 0.77261178, 23.24}, Counted{2, 2078, 0.003590052, 0.50952726, 54.22},
          Counted{2, 2483, 0.07473541, 0.78547676, 22.42}, Counted{3, 48'971, 0.08149026, 0.63925295, 56.85},
          Counted{2, 27'431, 0.003529412, 0.83539616, 17.89}, Counted{2, 25'553, 0.03752348, 0.7772724, 26.19},
          Counted{3, 494'242, 0.001956411, 0.8043485, 26.33, 0.034}}) {
      const Workload w = cube_workload(1, counted.samples, counted.disc, 2, counted.dimension);
      const double radius = w.sphere_radius * counted.ratio - w.disc_radius;
      CAPTURE(counted.samples);
      CHECK(single_rebuilds(w, radius, SampleOrder::lebesgue) == Approx(counted.rebuilds).epsilon(counted.within));
    }
  }

  TEST_CASE("balls of radius ρ in [-1, 1]³ start 34 to 65 ρ^-3 times (volume), 46 to 85 ρ^-2 times (faces)") {
    // The factor depends on the phase: over all phases it must reach both ends of its range.
    double least_in_volume = INFINITY;
    double most_in_volume = 0;
    double least_on_faces = INFINITY;
    double most_on_faces = 0;
    for (double radius = 0.05; radius < 0.2; radius *= 1.01) {
      const double in_volume =
          single_rebuilds(cube_workload(1, 1e9, 0.001, 2), radius, SampleOrder::lebesgue) * std::pow(radius, 3);
      const double on_faces =
          single_rebuilds(cube_workload(1, 1e9, 0.001, 2, 2), radius, SampleOrder::lebesgue) * std::pow(radius, 2);
      least_in_volume = std::min(least_in_volume, in_volume);
      most_in_volume = std::max(most_in_volume, in_volume);
      least_on_faces = std::min(least_on_faces, on_faces);
      most_on_faces = std::max(most_on_faces, on_faces);
    }
    CHECK(least_in_volume == Approx(34).epsilon(0.02));
    CHECK(most_in_volume == Approx(65).epsilon(0.02));
    CHECK(least_on_faces == Approx(46).epsilon(0.02));
    CHECK(most_on_faces == Approx(85).epsilon(0.02));
  }

  TEST_CASE("unsorted in a cube, all samples except those in the ball start a new one") {
    const double radius = 0.02;  // small compared with the side, so that the cube's faces have little effect
    const double share_within = 4 * 3.14159265 / 3 * std::pow(radius / 2, 3);
    CHECK(in_volume.samples - single_rebuilds(in_volume, radius, SampleOrder::none) ==
          Approx(in_volume.samples * share_within).epsilon(0.02));
    // In a unit cube, half of all pairs of points are closer than 0.6616.
    CHECK(single_rebuilds(in_volume, 2 * 0.66160, SampleOrder::none) == Approx(5e5).epsilon(0.01));
  }

  TEST_CASE("for balls with many samples the share varies with the phase by a factor of about two") {
    for (const double dimension : {2.0, 3.0})
      for (double lambda = 8; lambda < 1e5; lambda *= 1.5) {
        double least = 1;
        double most = 0;
        for (int phase = 0; phase <= 64; ++phase) {
          const double share = small_ball_share(dimension, lambda, phase / 64.0);
          least = std::min(least, share);
          most = std::max(most, share);
        }
        CHECK(most / least > 1.2);
        CHECK(most / least < 2.3);
      }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("invalid numbers, or numbers out of range, are refused by name") {
    for (const double bad : support::not_a_size)
      CHECK_THROWS_WITH_AS((void)single_rebuilds(2, 1e6, {bad, 9}), Contains("samples per ball"),
                           std::invalid_argument);
    for (const double bad : support::not_a_dimension)
      CHECK_THROWS_WITH_AS((void)single_rebuilds(bad, 1e6, {1, 9}), Contains("sample dimension"),
                           std::invalid_argument);
  }

  TEST_CASE("a workload, ratio or number of rebuilds out of range is refused by name") {
    for (const double bad : support::not_a_count) {
      Workload w = in_volume;
      w.samples = bad;
      for (const auto order : {SampleOrder::lebesgue, SampleOrder::none})
        CHECK_THROWS_WITH_AS((void)single_rebuilds(w, 0.1, order), Contains("number of samples"),
                             std::invalid_argument);
    }
    CHECK_THROWS_WITH_AS((void)single_rebuilds(in_volume, support::not_a_number, SampleOrder::lebesgue),
                         Contains("radius of the ball"), std::invalid_argument);
    const Ball ball{10, 5};
    for (const double bad : support::not_a_dimension)
      CHECK_THROWS_WITH_AS((void)own_rebuild_share(bad, ball, 1, 1), Contains("sample dimension"),
                           std::invalid_argument);
    for (const double bad : support::not_a_size) {
      CHECK_THROWS_WITH_AS((void)own_rebuild_share(3, {bad, 5}, 1, 1), Contains("samples per ball"),
                           std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)own_rebuild_share(3, ball, bad, 1), Contains("octaves"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)own_rebuild_share(3, ball, 1, bad), Contains("crowding"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)nested_rebuilds(bad, 1, 0.5, 10), Contains("rebuilds"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)nested_rebuilds(1, bad, 0.5, 10), Contains("rebuilds"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)nested_rebuilds(1, 1, bad, 10), Contains("share"), std::invalid_argument);
    }
    CHECK_THROWS_WITH_AS((void)own_rebuild_share(3, {10, support::not_a_number}, 1, 1), Contains("halvings"),
                         std::invalid_argument);
    for (const double bad : support::not_a_length) {
      CHECK_THROWS_WITH_AS((void)nested_rebuilds(1, 1, 0.5, bad), Contains("number of samples"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)ball_of(in_volume, bad), Contains("radius of the ball"), std::invalid_argument);
    }
  }
}
