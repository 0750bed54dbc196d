#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <stop_token>
#include <vector>

#include "detp/sim/estimate/estimate.hpp"
#include "detp/sim/geometry/random.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

Outcome nearest(const Problem& problem, int k, const RunOptions& options = {}) {
  return run(problem, {Technique::photon_map, PhotonMapParameters{k}}, options);
}

/// A ray that comes down from z = 1 and ends in the plane z = 0.
Ray down_to(double x, double y, double power) {
  return {.origin = {x, y, 1}, .direction = {0, 0, -1}, .length = 1, .power = power};
}

/// Photons spread evenly over the unit square, with total power 1.
std::vector<Ray> even_photons(std::size_t count) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const auto place = uniform4(77, Stream::tests, i);
    rays.push_back(down_to(place[0], place[1], 1.0 / static_cast<double>(count)));
  }
  return rays;
}

/// Discs in the square, away from its edges, 1/25 apart.
std::vector<Disc> lattice() {
  std::vector<Disc> discs;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y) discs.push_back({{0.12 + x / 25.0, 0.12 + y / 25.0, 0}, {0, 0, 1}, 0.01});
  return discs;
}

const std::vector<Disc> one_disc{{{0, 0, 0}, {0, 0, 1}, 0.5}};

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("the power of the k - 1 nearest photons over the area out to the k-th; lines leave no photon") {
    const std::vector<Ray> rays{
        down_to(3, 0, 11), down_to(0, 4, 13), {.origin = {0.1, 0, 1}}, down_to(0, -1, 5), down_to(-2, 0, 7)};
    const Outcome outcome = nearest(make_problem(rays, one_disc), 3, {.pairs = true});
    CHECK(outcome.irradiance[0] == doctest::Approx(12 / (9 * std::numbers::pi)).epsilon(1e-14));
    CHECK(outcome.hits[0] == 2);
    CHECK(outcome.total_hits == 2);
    CHECK(outcome.pairs == std::vector<Pair>{{3, 0}, {4, 0}});
    CHECK(outcome.counts == Counts<std::uint64_t>{.loaded = 5, .segments = 5, .references = 4, .hits = 2});
    CHECK(nearest(make_problem(rays, one_disc), 3, {.count = false}).counts == Counts<std::uint64_t>{.hits = 2});
  }

  TEST_CASE("the plain form: the power of all k, k/(k - 1) times too large on average") {
    const std::vector<Ray> rays{down_to(3, 0, 11), down_to(0, 4, 13), down_to(0, -1, 5), down_to(-2, 0, 7)};
    const auto plain = [](const Problem& problem, int k, const RunOptions& options = {}) {
      return estimate(problem, {.estimator = Estimator::nearest, .nearest = k, .nearest_form = NearestForm::plain},
                      options);
    };
    const Outcome outcome = plain(make_problem(rays, one_disc), 3);
    CHECK(outcome.irradiance[0] == doctest::Approx((5 + 7 + 11) / (9 * std::numbers::pi)).epsilon(1e-14));
    CHECK(outcome.hits[0] == 3);
    const auto many = even_photons(20'000);
    const auto discs = lattice();
    const Problem problem = make_problem(many, discs);
    constexpr int k = 20;
    const Outcome even = plain(problem, k, {.standard_error = true});
    double mean = 0;
    double stated = 0;
    double found = 0;
    for (std::size_t i = 0; i < discs.size(); ++i) {
      mean += even.irradiance[i] / 400;
      stated += std::pow(even.standard_error[i], 2) / 400;
      found += std::pow(even.irradiance[i] - k / (k - 1.0), 2) / 400;
    }
    const double standard_error = k / (k - 1.0) * std::sqrt(1.0 / (k - 2) / 400);
    CHECK(std::abs(mean - k / (k - 1.0)) < 4 * standard_error);
    CHECK(std::abs(mean - 1) > 4 * standard_error);
    CHECK(std::sqrt(stated / found) == doctest::Approx(1).epsilon(0.15));
  }

  TEST_CASE("a photon is where it met a surface, however far its ray goes on; a ray that met none has no photon") {
    const std::vector<Ray> rays{down_to(0, -1, 5), down_to(-2, 0, 7), down_to(3, 0, 11), down_to(0.1, 0, 100)};
    const Outcome ends = nearest(make_problem(std::span(rays).first(3), one_disc), 3);
    std::vector<Ray> longer = rays;
    std::vector<double> landings;
    for (Ray& ray : longer) {
      landings.push_back(ray.length);
      ray.length += 0.7;
    }
    landings.back() = unbounded;
    const Outcome landed = nearest(make_problem(PathRays{longer, {}, landings}, one_disc), 3);
    CHECK(landed.irradiance == ends.irradiance);
    CHECK(landed.counts.references == 3);
  }

  TEST_CASE("fronts only: photons from behind do not count, and with too few in front the irradiance is 0") {
    std::vector<Ray> rays{down_to(1, 0, 2), down_to(2, 0, 3), down_to(3, 0, 4)};
    rays.push_back({.origin = {0.5, 0, -1}, .direction = {0, 0, 1}, .length = 1});
    const std::vector<Disc> both{{{0, 0, 0}, {0, 0, 1}, 0.5}, {{0, 0, 0}, {0, 0, -1}, 0.5}};
    const Outcome outcome = nearest(make_problem(rays, both, true), 3);
    CHECK(outcome.irradiance[0] == doctest::Approx(5 / (9 * std::numbers::pi)).epsilon(1e-14));
    CHECK(outcome.irradiance[1] == 0);
    CHECK(outcome.hits == std::vector<std::uint64_t>{2, 0});
  }

  TEST_CASE("even photons on a plane: their flux within its standard error, which refutes k instead of k - 1") {
    const auto rays = even_photons(20'000);
    const auto discs = lattice();
    const Problem problem = make_problem(rays, discs);
    for (const int k : {5, 20}) {
      const Outcome outcome = nearest(problem, k);
      double mean = 0;
      for (const double irradiance : outcome.irradiance) mean += irradiance / 400;
      // Each of the 400 estimates uses other photons. Its variance is 1/(k - 2), up to a relative error of k/20000.
      const double standard_error = std::sqrt(1.0 / (k - 2) / 400);
      CHECK(std::abs(mean - 1) < 4 * standard_error);
      if (k == 5) CHECK(std::abs(mean * k / (k - 1) - 1) > 4 * standard_error);
    }
  }

  TEST_CASE("a stop request ends the search early and is reported") {
    const auto rays = even_photons(1000);
    const auto discs = lattice();
    std::stop_source source;
    source.request_stop();
    const Outcome outcome = nearest(make_problem(rays, discs), 5, {.stop = source.get_token()});
    CHECK(outcome.stopped);
    CHECK(outcome.total_hits == 0);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("no photon, fewer than k, k in one place, and blocks of rays are refused with the reason") {
    const auto refuses = [](const std::vector<Ray>& rays, int k, const char* why, const RunOptions& options = {}) {
      const Problem problem = make_problem(rays, one_disc);
      CHECK_THROWS_WITH_AS(static_cast<void>(nearest(problem, k, options)), doctest::Contains(why),
                           std::invalid_argument);
    };
    refuses({Ray{}, Ray{}, Ray{}}, 3, "no ray met one");
    refuses(even_photons(9), 10, "needs the 10 nearest photons, but the rays have only 9");
    refuses(std::vector<Ray>(9, down_to(0, 0, 1)), 9, "9 photons lie at the centre of disc 0");
    Totals totals;
    refuses(even_photons(9), 3, "all rays at once", {.totals = &totals});
    CHECK_NOTHROW(static_cast<void>(nearest(make_problem(even_photons(9), one_disc), 9)));
  }
}
