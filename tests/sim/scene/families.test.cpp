#include "detp/sim/scene/families/families.hpp"

#include <doctest/doctest.h>

#include <set>
#include <stdexcept>
#include <string>

#include "detp/sim/open/open_scene.hpp"

namespace detp::sim {
namespace {

Scene open_family(std::string_view family, const std::string& seed) {
  return open_scene({.name = "@" + std::string(family) + ":" + seed, .samples = {}});
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("each family has another scene for each seed, with samples and light") {
    for (const families::Family& family : families::all_families) {
      CAPTURE(family.name);
      std::set<std::size_t> counts;
      for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const Scene scene = open_family(family.name, std::to_string(seed));
        CHECK(scene.samples.size() >= 1000);
        CHECK(scene.samples.size() <= 200'000);
        CHECK_FALSE(scene.lights.empty());
        CHECK_NOTHROW(check(scene.mesh.materials, scene.mesh.triangles.size()));
        CHECK(scene.mesh.positions == open_family(family.name, std::to_string(seed)).mesh.positions);
        counts.insert(scene.samples.size());
      }
      CHECK(counts.size() == 4);
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a family needs a whole number as seed") {
    for (const char* seed : {"", "x", "-1", "1.5", "1x", "99999999999999999999999"})
      CHECK_THROWS_AS(static_cast<void>(open_family("room", seed)), std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(open_scene({.name = "@room", .samples = {}})), std::invalid_argument);
  }
}

}  // namespace detp::sim
