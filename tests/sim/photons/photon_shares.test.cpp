#include "detp/sim/photons/photon_paths.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/photons/photon_source.hpp"
#include "detp/sim/photons/photon_walk.hpp"
#include "support/boxes.hpp"

using namespace detp::sim;

TEST_SUITE("photon shares") {
  TEST_CASE("the mean path length has no bias, which equal shares have") {
    constexpr int runs = 200'000;
    constexpr double mean_length = 10;
    std::mt19937_64 random(1);
    std::geometric_distribution<std::uint64_t> length(1 / mean_length);
    for (const std::uint64_t wanted : {5, 30, 100}) {
      double unbiased = 0;
      double equal = 0;
      double square = 0;
      for (int run = 0; run < runs; ++run) {
        std::vector<std::uint64_t> pieces;
        for (std::uint64_t all = 0; all < wanted; all += pieces.back()) pieces.push_back(1 + length(random));
        const auto n = static_cast<double>(pieces.size());
        const double mean = static_cast<double>(std::accumulate(pieces.begin(), pieces.end(), std::uint64_t{0})) / n;
        const std::vector<double> shares = photon_shares(pieces, wanted);
        double own = shares.empty() ? mean : 0;
        for (std::size_t i = 0; i < shares.size(); ++i) own += shares[i] * static_cast<double>(pieces[i]);
        CHECK(std::abs(std::accumulate(shares.begin(), shares.end(), 0.0) - (shares.empty() ? 0 : 1)) < 1e-12);
        unbiased += own / runs;
        square += own * own / runs;
        equal += mean / runs;
      }
      CAPTURE(wanted);
      const double error = std::sqrt((square - unbiased * unbiased) / runs);
      CHECK(std::abs(unbiased - mean_length) < 4.5 * error);
      CHECK(std::abs(equal - mean_length) > 10 * error);
    }
  }

  TEST_CASE("with one piece for each photon, and with many photons, all are equal") {
    CHECK(photon_shares(std::vector<std::uint64_t>(100, 1), 100).empty());
    CHECK(photon_shares(std::vector<std::uint64_t>(5000, 3), 14'999).empty());
    CHECK(photon_shares(std::vector<std::uint64_t>{7}, 5).empty());
    CHECK(photon_shares(std::vector<std::uint64_t>{5, 1000}, 100) == std::vector<double>{1, 0});
  }

  TEST_CASE("a stream has the same powers and the same ledger as paths in memory") {
    for (const char* name : {"@cornell", "@tree"})
      for (const std::uint64_t count : {50, 3000, 20'000}) {
        const Scene scene = open_scene({.name = name, .samples = {}});
        const TracedPaths paths = photon_paths(scene, count, 3);
        const PhotonSource source(scene, count, 3);
        std::vector<Ray> rays(source.size());
        source.read(0, rays);
        REQUIRE(rays.size() == paths.rays.size());
        const double photons = source.scale(source.size()) == 1 ? 1 : static_cast<double>(source.photons());
        for (std::size_t i = 0; i < rays.size(); ++i) REQUIRE(rays[i].power / photons == paths.rays[i].power);
        CHECK(paths.light.all_photons() == paths.photon_count);
        const LightLedger light = source.light_of(source.photons());
        CHECK(light.photons == paths.light.photons);
        CHECK(light.landings == paths.light.landings);
        for (std::size_t i = 0; i < path_ends; ++i)
          CHECK(light.power[i] == doctest::Approx(paths.light.power[i]).epsilon(1e-12));
      }
  }
}
