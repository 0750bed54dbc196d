#include "detp/validate/bench/workload.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

using namespace detp;
using namespace detp::validate;

namespace {

constexpr std::array all_awkward{AwkwardScene::clusters, AwkwardScene::tiny_object, AwkwardScene::thin_sheet,
                                 AwkwardScene::strays, AwkwardScene::mixed_radii};

bool is_same(const sim::Disc& a, const sim::Disc& b) {
  return a.centre == b.centre && a.normal == b.normal && a.radius == b.radius;
}

bool is_in_cube(const glm::dvec3& point) {
  return std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)}) <= 0.5;
}

/// The number of discs for which the predicate holds.
std::size_t discs_where(const std::vector<sim::Disc>& discs, const auto& predicate) {
  return static_cast<std::size_t>(std::count_if(discs.begin(), discs.end(), predicate));
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("an awkward disc is a function of the seed and its number") {
    for (const AwkwardScene scene : all_awkward) {
      CAPTURE(name(scene));
      const auto few = awkward_discs(scene, 10, 0.1, 7);
      const auto many = awkward_discs(scene, 30, 0.1, 7);
      const auto others = awkward_discs(scene, 10, 0.1, 8);
      REQUIRE(few.size() == 10);
      CHECK(std::equal(few.begin(), few.end(), many.begin(), is_same));
      CHECK_FALSE(std::equal(few.begin(), few.end(), others.begin(), is_same));
    }
  }

  TEST_CASE("awkward discs have isotropic unit normals, and one radius unless the radii are mixed") {
    constexpr std::size_t count = 5000;
    for (const AwkwardScene scene : all_awkward) {
      CAPTURE(name(scene));
      glm::dvec3 sum(0);
      const auto discs = awkward_discs(scene, count, 0.1, 1);
      for (const sim::Disc& disc : discs) {
        REQUIRE(glm::length(disc.normal) == doctest::Approx(1));
        sum += disc.normal;
      }
      CHECK(glm::length(sum) < 5 * std::sqrt(static_cast<double>(count)));
      CHECK((discs_where(discs, [](const auto& disc) { return disc.radius == 0.1; }) == count) ==
            (scene != AwkwardScene::mixed_radii));
    }
  }

  TEST_CASE("the largest of 20 clusters is 300 times as large as the smallest") {
    const auto discs = awkward_discs(AwkwardScene::clusters, 20'000, 0.001, 1);
    for (const std::size_t cluster : {0, 19}) {
      glm::dvec3 mean(0);
      for (std::size_t i = cluster; i < discs.size(); i += 20) mean += discs[i].centre / 1000.0;
      double square = 0;
      for (std::size_t i = cluster; i < discs.size(); i += 20)
        square += glm::dot(discs[i].centre - mean, discs[i].centre - mean) / 1000.0;
      CHECK(std::sqrt(square / 3) == doctest::Approx(cluster == 0 ? 0.1 : 0.0003).epsilon(0.1));
    }
  }

  TEST_CASE("half of the discs lie on the floor, half on a ball with a hundredth of its side as diameter") {
    const auto discs = awkward_discs(AwkwardScene::tiny_object, 2000, 0.001, 1);
    CHECK(discs_where(discs, [](const auto& disc) { return disc.centre.y == 0 && is_in_cube(disc.centre); }) == 1000);
    const glm::dvec3 middle = discs[1].centre;
    CHECK(discs_where(discs, [&](const auto& disc) { return glm::length(disc.centre - middle) <= 0.0101; }) >= 1000);
  }

  TEST_CASE("a thin sheet has no thickness, and five of the strays lie far outside the cube of the others") {
    const auto sheet = awkward_discs(AwkwardScene::thin_sheet, 1000, 0.001, 1);
    CHECK(discs_where(sheet, [](const auto& disc) { return disc.centre.y == 0 && is_in_cube(disc.centre); }) == 1000);
    const auto strays = awkward_discs(AwkwardScene::strays, 1000, 0.001, 1);
    CHECK(discs_where(strays, [](const auto& disc) { return is_in_cube(disc.centre); }) == 995);
    CHECK(discs_where(strays, [](const auto& disc) { return glm::length(disc.centre) > 100; }) == 5);
  }

  TEST_CASE("mixed radii are log-normal: the median is the radius, a factor of e one standard deviation") {
    const auto discs = awkward_discs(AwkwardScene::mixed_radii, 10'000, 0.01, 1);
    const auto share_below = [&](double radius) {
      return static_cast<double>(discs_where(discs, [&](const auto& disc) { return disc.radius < radius; })) / 1e4;
    };
    CHECK(share_below(0.01) == doctest::Approx(0.5).epsilon(0.05));
    CHECK(share_below(0.01 * std::exp(1)) == doctest::Approx(0.841).epsilon(0.02));
    CHECK(share_below(0.01 * std::exp(-2)) == doctest::Approx(0.0228).epsilon(0.3));
  }
}
