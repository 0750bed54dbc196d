#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <optional>
#include <random>
#include <stdexcept>
#include <vector>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/photons/photon_source.hpp"
#include "detp/sim/photons/photon_walk.hpp"
#include "support/boxes.hpp"

using namespace detp::sim;

namespace {

/// All rays of the source, with the powers of photon_paths.
Paths read_all(const PhotonSource& source, std::size_t block) {
  Paths paths;
  BesideRays beside;
  const std::vector<std::uint64_t>& photons = beside.photons;
  while (paths.rays.size() < source.size()) {
    const std::size_t first = paths.rays.size();
    const std::uint64_t end = source.block_end(first, block);
    REQUIRE(end > first);
    paths.rays.resize(end);
    source.read_all(first, std::span(paths.rays).subspan(first), beside);
    paths.photons.insert(paths.photons.end(), photons.begin(), photons.end());
    paths.further.insert(paths.further.end(), beside.further.begin(), beside.further.end());
    CHECK(source.photons_of(end) > photons.back());
  }
  paths.photon_count = source.photons();
  if (source.scale(source.size()) == 1) return paths;
  CHECK(source.scale(source.size()) == 1 / static_cast<double>(paths.photon_count));
  for (Ray& ray : paths.rays) ray.power /= static_cast<double>(paths.photon_count);
  for (double& power : paths.further) power /= static_cast<double>(paths.photon_count);
  return paths;
}

/// Compares the source's rays with photon_paths, for some blocks.
void compare_blocks(double kept, Counting counting) {
  CAPTURE(kept);
  for (const char* name : {"@cornell", "@cornell in colours", "@tree-coarse"}) {
    const bool rgb = name == std::string("@cornell in colours");
    const Scene scene = open_scene({.name = rgb ? "@cornell" : name, .samples = {}, .rgb = rgb});
    for (const std::size_t count : {1, 5001, 150'000}) {
      INFO("name ", name, ", count ", count);
      const TracedPaths expected = photon_paths(scene, count, 3);
      const PhotonSource source(scene, count, 3, caster_for(scene), {}, nullptr, counting);
      const std::size_t size = expected.rays.size();
      for (const std::size_t block : {std::size_t{1}, std::size_t{700}, size}) {
        if (block < std::min<std::size_t>(size, 700) || 10'000 * block < size) continue;  // a group for each block
        const Paths found = read_all(source, block);
        REQUIRE(source.size() == size);
        CHECK(found.photon_count == expected.photon_count);
        CHECK(found.photons == expected.photons);
        CHECK(found.further == expected.further);
        CHECK(std::memcmp(found.rays.data(), expected.rays.data(), size * sizeof(Ray)) == 0);
      }
      const LightLedger light = source.light_of(source.photons());
      CHECK(light.photons == expected.light.photons);
      CHECK(light.landings == expected.light.landings);
      if (counting == Counting::as_read) continue;
      CHECK(source.kept_bytes(1) <= PhotonSource::most_kept_bytes());
      if (kept > 1e8) CHECK(source.kept_bytes(1) >= 72.0 * static_cast<double>(size));
    }
  }
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("photons by number are photon_paths, byte for byte" * doctest::test_suite("long")) {
    for (const double kept : {0.0, 2000.0, 1e9}) {  // rays
      set_memory_limit(16 * 72 * kept + 1e6);
      compare_blocks(kept, Counting::ahead);
      compare_blocks(kept, Counting::as_read);
    }
    set_memory_limit(std::nullopt);
  }
}

TEST_SUITE("limit") {
  TEST_CASE("rays counted as they are read are traced block by block" * doctest::test_suite("long")) {
    const Scene scene = open_scene({.name = "@cornell", .samples = {}});
    const PhotonSource source(scene, 1'000'000, 3, caster_for(scene), {}, nullptr, Counting::as_read);
    CHECK(source.size() == 1'000'000);
    CHECK(source.photons() < 200'000);
    const std::uint64_t end = source.block_end(0, 100'000);
    CHECK(end <= 100'000);
    CHECK(end > 99'000);
    CHECK(source.photons() < 200'000);
    CHECK(source.light_of(source.photons_of(end)).all_photons() == source.photons_of(end));
    CHECK(read_all(source, 300'000).rays.size() == photon_paths(scene, 1'000'000, 3).rays.size());
  }

  TEST_CASE("no photon's piece starts farther away than farthest_from reports") {
    const Scene scene = open_scene({.name = "@cornell", .samples = {}});
    const std::vector<Ray> rays = photon_paths(scene, 5000, 3).rays;
    const PhotonSource source(scene, rays.size(), 3);
    for (const glm::dvec3& point : {scene.box.centre(), scene.box.low, scene.box.high + 3.0}) {
      double farthest = 0;
      for (const Ray& ray : rays) farthest = std::max(farthest, glm::distance(ray.origin, point));
      CHECK(source.farthest_from(point) >= farthest);
      CHECK(source.farthest_from(point) < 2 * farthest);
    }
  }

  TEST_CASE("farthest_from holds for every kind of light, inside and outside of the scene") {
    Scene scene = open_scene({.name = "@cornell", .samples = {}});
    const glm::dvec3 size = scene.box.size();
    const glm::dvec3 above = scene.box.high + size;
    const std::vector<Light> lights{{PointLight{above}},
                                    {SpotLight{above, scene.box.centre() - above, 0.3}},
                                    {AreaLight{above, {-size.x, 0, 0}, {0, 0, -size.z}}},
                                    {DirectionalLight{{1, -2, 0.5}}},
                                    {EnvironmentLight{}}};
    for (const Light& light : lights) {
      CAPTURE(name(kind_of(light)));
      scene.lights = {light};
      const TracedPaths paths = photon_paths(scene, 3000, 3);
      const PhotonSource source(scene, 3000, 3);
      for (const glm::dvec3& point : {scene.box.centre(), scene.box.low, scene.box.high + 30.0}) {
        double farthest = 0;
        for (const Ray& ray : paths.rays) farthest = std::max(farthest, glm::distance(ray.origin, point));
        CHECK(source.farthest_from(point) >= farthest);
        CHECK(source.farthest_from(point) < 3 * farthest);
      }
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a light that meets no surface is refused instead of traced for ever") {
    Scene scene = open_scene({.name = "@cornell", .samples = {}});
    scene.lights = {{PointLight{scene.box.high + 1000.0 * scene.box.size()}}};
    CHECK_THROWS_WITH_AS(PhotonSource(scene, 50, 1), doctest::Contains("hardly meets"), std::invalid_argument);
  }

  TEST_CASE("more rays than can be numbered in memory are refused before they are traced") {
    const Scene scene = open_scene({.name = "@cornell", .samples = {}});
    CHECK_THROWS_AS(PhotonSource(scene, 1'000'000'000'000'000'000, 1), std::length_error);
  }
}

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

  TEST_CASE("a stream has the same powers and the same ledger as paths in memory" * doctest::test_suite("long")) {
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
