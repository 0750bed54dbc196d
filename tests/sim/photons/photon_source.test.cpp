#include "detp/sim/photons/photon_source.hpp"
#include "detp/sim/open/open_scene.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <vector>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/photons/photon_paths.hpp"

using namespace detp::sim;

namespace {

/// Compares the source's rays with photon_paths, for some blocks.
void compare_blocks(double kept) {
  CAPTURE(kept);
  for (const char* name : {"@cornell", "@tree-coarse"}) {
    const Scene scene = open_scene({.name = name, .samples = {}});
    for (const std::size_t count : {1, 5001}) {
      CAPTURE(name);
      CAPTURE(count);
      const Paths expected = photon_paths(scene, count, 3);
      const PhotonSource source(scene, count, 3);
      const std::size_t size = expected.rays.size();
      REQUIRE(source.size() == size);
      CHECK(source.photons() == expected.photon_count);
      CHECK(source.kept_bytes() <= PhotonSource::most_kept_bytes());
      if (kept > 1e8) CHECK(source.kept_bytes() >= 72.0 * static_cast<double>(size));
      for (const std::size_t block : {std::size_t{1}, std::size_t{700}, size}) {
        if (block == 1 && count > 1) continue;  // traces a group for each photon
        std::vector<Ray> rays(size);
        std::vector<std::uint64_t> photons;
        std::vector<std::uint64_t> of_block;
        for (std::size_t first = 0; first < size;) {
          const std::uint64_t end = source.block_end(first, block);
          REQUIRE(end > first);
          if (end < size) CHECK(expected.photons[end] != expected.photons[end - 1]);
          source.read_numbered(first, std::span(rays).subspan(first, end - first), of_block);
          photons.insert(photons.end(), of_block.begin(), of_block.end());
          first = end;
        }
        CHECK(std::memcmp(rays.data(), expected.rays.data(), size * sizeof(Ray)) == 0);
        CHECK(photons == expected.photons);
      }
    }
  }
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("photons by number are photon_paths, byte for byte, for any blocks, whether their rays are kept or not") {
    for (const double kept : {0.0, 2000.0, 1e9}) {  // rays
      set_memory_limit(16 * 72 * kept + 1e6);
      compare_blocks(kept);
    }
    set_memory_limit(std::nullopt);
  }
}

TEST_SUITE("limit") {
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
