#include "detp/sim/photons/scatter.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"

using namespace detp::sim;

namespace {

const Material mirror{.diffuse = 0, .specular = 1};
const Material glass{.diffuse = 0, .glass = 1, .index = 1.5};

glm::dvec3 towards(double angle) { return {std::sin(angle), 0, -std::cos(angle)}; }

constexpr glm::dvec3 up{0, 0, 1};
constexpr std::array<double, 4> never{0.5, 0.5, 0.5, 1 - 1e-12};  // no random reflection

/// Chi-square of the directions' z² over ten equal bins, for cosine-distributed directions.
double chi_square_of_cosine_law(const std::vector<glm::dvec3>& directions) {
  std::array<double, 10> counts{};
  for (const glm::dvec3& one : directions)
    ++counts[std::min<std::size_t>(9, static_cast<std::size_t>(10 * one.z * one.z))];
  const double expected = static_cast<double>(directions.size()) / 10;
  double sum = 0;
  for (const double count : counts) sum += (count - expected) * (count - expected) / expected;
  return sum;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("Fresnel: 4 % at normal incidence on glass, Brewster's angle, total reflection, grazing light") {
    CHECK(fresnel_reflectance(1, 1.5) == doctest::Approx(0.04).epsilon(1e-14));
    const double brewster = std::atan(1.5);
    const double behind = std::asin(std::sin(brewster) / 1.5);
    const double across = std::pow(std::sin(brewster - behind) / std::sin(brewster + behind), 2);
    CHECK(fresnel_reflectance(std::cos(brewster), 1.5) == doctest::Approx(0.5 * across).epsilon(1e-12));
    CHECK(fresnel_reflectance(std::cos(0.8), 1 / 1.5) == 1);  // critical angle: 0.7297
    CHECK(fresnel_reflectance(std::cos(0.7), 1 / 1.5) < 0.3);
    CHECK(fresnel_reflectance(1e-9, 1.5) == doctest::Approx(1).epsilon(1e-7));
    CHECK(fresnel_reflectance(0.3, 1) == doctest::Approx(0).epsilon(1e-14));
  }

  TEST_CASE("Fresnel is the same both ways") {
    for (const double angle : {0.1, 0.5, 1.0, 1.4}) {
      const double behind = std::asin(std::sin(angle) / 1.5);
      CHECK(fresnel_reflectance(std::cos(angle), 1.5) ==
            doctest::Approx(fresnel_reflectance(std::cos(behind), 1 / 1.5)).epsilon(1e-12));
    }
  }

  TEST_CASE("glass refracts by Snell's law, from either side, and turns totally reflected light back") {
    for (const double angle : {0.0, 0.3, 1.0, 1.5}) {
      CAPTURE(angle);
      const auto inside = scattered(glass, up, towards(angle), never);
      REQUIRE(inside);
      CHECK(std::sqrt(inside->x * inside->x + inside->y * inside->y) ==
            doctest::Approx(std::sin(angle) / 1.5).epsilon(1e-12));
      CHECK(inside->z < 0);
      const auto outside = scattered(glass, -up, *inside, never);
      REQUIRE(outside);
      CHECK(glm::length(*outside - towards(angle)) < 1e-9);
    }
    const auto reflected = scattered(glass, -up, towards(0.9), never);
    REQUIRE(reflected);
    CHECK(reflected->z == doctest::Approx(std::cos(0.9)));
    CHECK(reflected->x == doctest::Approx(std::sin(0.9)));
  }

  TEST_CASE("a mirror mirrors, on either side") {
    for (const double side : {1.0, -1.0}) {
      const auto direction = scattered(mirror, side * up, towards(0.7), {0.3, 0.1, 0.9, 0.5});
      REQUIRE(direction);
      CHECK(glm::length(*direction - glm::dvec3{std::sin(0.7), 0, std::cos(0.7)}) < 1e-15);
    }
  }

  TEST_CASE("each share is drawn as often as the material says; the rest is absorbed") {
    const Material mixed{.diffuse = 0.3, .specular = 0.2, .glass = 0.1};
    const auto direction = [&](double random) {
      return scattered(mixed, up, towards(0.7), {random, 0.5, 0.5, 0.9999});
    };
    CHECK(direction(0.299)->z != doctest::Approx(std::cos(0.7)));
    CHECK(direction(0.301)->z == doctest::Approx(std::cos(0.7)));
    CHECK(direction(0.499)->z == doctest::Approx(std::cos(0.7)));
    CHECK(direction(0.501)->z < 0);
    CHECK(direction(0.599)->z < 0);
    CHECK_FALSE(direction(0.601));
  }
}

TEST_SUITE("statistical") {
  TEST_CASE("uniform light stays uniform after any material: directions keep the cosine law") {
    constexpr std::uint64_t count = 100'000;
    constexpr double limit = 37.3;  // of chi-square with 9 degrees of freedom: exceeded once in 43 000 times
    const auto law_after = [&](const Material& material) {
      std::vector<glm::dvec3> out;
      for (std::uint64_t i = 0; i < count; ++i) {
        const auto start = uniform4(1, Stream::tests, i, 1);
        const glm::dvec3 in = -cosine_direction(up, start[0], start[1]);
        if (const auto direction = scattered(material, up, in, uniform4(1, Stream::tests, i, 2)))
          out.push_back(*direction);
      }
      return out;
    };
    for (const double shininess : {1.0, 10.0, 1000.0}) {
      CAPTURE(shininess);
      const auto out = law_after({.diffuse = 0, .specular = 1, .shininess = shininess});
      CHECK(out.size() == count);
      CHECK(chi_square_of_cosine_law(out) < limit);
    }
    const auto diffuse = law_after({.diffuse = 1});
    CHECK(chi_square_of_cosine_law(diffuse) < limit);
    auto forgotten = diffuse;  // negative control: uniform directions instead of the cosine law
    for (std::uint64_t i = 0; i < count; ++i) {
      const auto random = uniform4(1, Stream::tests, i, 3);
      forgotten[i] = uniform_direction(random[0], random[1]);
    }
    CHECK(chi_square_of_cosine_law(forgotten) > 100 * limit);
  }

  TEST_CASE("uniform light on both sides of glass stays balanced: as much passes in as out, by the basic law") {
    // Inside, uniform light is n² times as dense. Of it, and of the light outside, equal powers pass.
    constexpr std::uint64_t count = 400'000;
    double in = 0;
    double out = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      const auto start = uniform4(2, Stream::tests, i, 1);
      const auto random = uniform4(2, Stream::tests, i, 2);
      const glm::dvec3 down = -cosine_direction(up, start[0], start[1]);
      if (scattered(glass, up, down, random)->z < 0) ++in;
      if (scattered(glass, -up, down, random)->z < 0) out += 1.5 * 1.5;
    }
    const double error = 1.5 * std::sqrt(count * 1.0);
    CHECK(std::abs(in - out) < 4.5 * error);
    CHECK(in > 0.8 * count);
  }

  TEST_CASE("near the normal the glossy lobe is Phong's: the mean of 1 - cos is 1 / (n + 1) ... 1 / n") {
    const Material glossy{.diffuse = 0, .specular = 1, .shininess = 400};
    double sum = 0;
    constexpr std::uint64_t count = 100'000;
    for (std::uint64_t i = 0; i < count; ++i) sum += 1 - scattered(glossy, up, -up, uniform4(3, Stream::tests, i))->z;
    CHECK(sum / count == doctest::Approx(1.0 / 400).epsilon(0.015));
  }
}
