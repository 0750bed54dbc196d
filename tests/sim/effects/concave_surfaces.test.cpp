#include "detp/sim/effects/concave_surfaces.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stop_token>
#include <vector>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/effects/observe.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/rays/line_field.hpp"

using namespace detp;

namespace {

bool is_on(const sim::Finding& finding) {
  return sim::EffectSelection().is_on(sim::concave_surfaces, finding.value, finding.standard_error);
}

/// A sphere of radius 1 in rings of latitude. `facing` 1: the normals point outwards, -1: inwards.
std::vector<sim::Disc> globe(double facing, double radius) {
  std::vector<sim::Disc> discs;
  constexpr int rings = 100;
  for (int ring = 0; ring < rings; ++ring) {
    const double z = std::cos(std::numbers::pi * (ring + 0.5) / rings);
    const double across = std::sqrt(1 - z * z);
    const auto points = static_cast<int>(std::ceil(2 * rings * across));
    for (int i = 0; i < points; ++i) {
      const double turn = 2 * std::numbers::pi * i / points;
      const glm::dvec3 point(across * std::cos(turn), across * std::sin(turn), z);
      discs.push_back({.centre = point, .normal = facing * point, .radius = radius});
    }
  }
  return discs;
}

/// A square of side 100 with its upper side at height 0, but for random heights up to `rough`.
std::vector<sim::Disc> floor(double rough, double radius) {
  std::vector<sim::Disc> discs;
  for (std::size_t i = 0; i < 10'000; ++i) {
    const double height = rough * sim::uniform4(1, sim::Stream::tests, i)[0];
    discs.push_back({.centre = {static_cast<double>(i % 100), static_cast<double>(i / 100), height}, .radius = radius});
  }
  return discs;
}

}  // namespace

TEST_SUITE("effects") {
  TEST_CASE("every disc inside a sphere has a neighbour in front, no disc outside of it") {
    for (const double radius : {0.01, 0.06, 0.2}) {  // 0.03 apart
      CAPTURE(radius);
      const sim::Finding inside = sim::concavity(globe(-1, radius));
      CHECK(inside.value == (radius > 0.05 ? 1 : 0));  // the sphere is r/2 over the rim of a disc of radius r
      CHECK(is_on(inside) == (radius > 0.05));
      const sim::Finding outside = sim::concavity(globe(1, radius));
      CHECK(sim::concavity(globe(1, radius), false).value == inside.value);  // light inside of a glass ball
      CHECK(outside.value == 0);
      CHECK_FALSE(is_on(outside));
    }
  }

  TEST_CASE("a floor is flat up to a fiftieth of the radius") {
    for (const double radius : {0.3, 1.5}) {
      CAPTURE(radius);
      CHECK(sim::concavity(floor(0, radius)).value == 0);
      CHECK(sim::concavity(floor(0.02 * radius, radius)).value == 0);
      CHECK(sim::concavity(floor(10 * radius, radius)).value > 0.3);
    }
  }

  TEST_CASE("a share of concave discs is found to four standard errors") {
    auto discs = floor(0, 1.5);
    std::vector<bool> concave(discs.size());
    for (std::size_t i = 550; i < discs.size(); i += 900) {  // raises single discs far from each other
      discs[i].centre.z = 0.5;
      for (const std::size_t beside : {i - 101, i - 100, i - 99, i - 1, i + 1, i + 99, i + 100, i + 101})
        concave[beside] = true;
    }
    const auto share = static_cast<double>(std::count(concave.begin(), concave.end(), true)) / 1e4;
    const sim::Finding found = sim::concavity(discs);
    CHECK(std::abs(found.value - share) < 4 * found.standard_error);
    CHECK(found.standard_error < 0.02);
  }

  TEST_CASE("an array without order in space is searched along the curve") {
    auto discs = globe(-1, 0.2);
    std::vector<std::pair<double, sim::Disc>> shuffled;
    for (std::size_t i = 0; i < discs.size(); ++i)
      shuffled.emplace_back(sim::uniform4(2, sim::Stream::tests, i)[0], discs[i]);
    std::sort(shuffled.begin(), shuffled.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::transform(shuffled.begin(), shuffled.end(), discs.begin(), [](const auto& one) { return one.second; });
    CHECK(sim::concavity(discs).value > 0.9);
  }

  TEST_CASE("samples at the same point and neighbours right above a disc do not make a surface concave") {
    CHECK(sim::concavity(std::vector<sim::Disc>(1000)).value == 0);
    CHECK(sim::concavity(std::vector<sim::Disc>(1)).value == 0);
    std::vector<sim::Disc> storeys;
    for (int i = 0; i < 1000; ++i) storeys.push_back({.centre = {0, 0, 2.0 * i}});
    CHECK(sim::concavity(storeys).value == 0);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a stop request ends the search for concave surfaces") {
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_AS((void)sim::concavity(std::vector<sim::Disc>(100'000), true, source.get_token()), sim::Stopped);
  }
}
