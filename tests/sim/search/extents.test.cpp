#include "detp/sim/search/extents.hpp"

#include <doctest/doctest.h>

#include <vector>

#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/search/soundness.hpp"
#include "support/machine.hpp"
#include "support/not_a_length.hpp"

using namespace detp::sim;
using detp::support::infinity;
using detp::support::not_a_number;
using detp::support::with_each_instruction_set;

namespace {

constexpr double power_limit = 1e200;
const glm::dvec3 from{0.1, -0.2, 0.3};

glm::dvec3 vector_at(std::size_t i, std::uint32_t seed) {
  const auto u = uniform4(seed, Stream::tests, i);
  return {u[0] - 0.5, u[1] - 0.5, u[2] - 0.5};
}

std::vector<Disc> some_discs(std::size_t count) {
  std::vector<Disc> discs;
  for (std::size_t i = 0; i < count; ++i)
    discs.push_back({vector_at(i, 1), unit_or_zero(vector_at(i, 2)), 0.01 + 0.001 * static_cast<double>(i * 7 % 11)});
  return discs;
}

std::vector<Ray> some_rays(std::size_t count) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i)
    rays.push_back({vector_at(i, 3), unit_or_zero(vector_at(i, 4)), i % 3 == 0 ? unbounded : 1 + vector_at(i, 5).x,
                    static_cast<double>(i * 5 % 13)});
  return rays;
}

/// The extent, found by adding one item after another.
DiscExtent one_by_one(const std::vector<Disc>& discs) {
  DiscExtent extent;
  for (const Disc& disc : discs) {
    Box centre;
    centre.include(disc.centre);
    extent = joined(extent, {centre, disc.radius, disc.radius, surely_sound(disc)});
  }
  return extent;
}

RayExtent one_by_one(const std::vector<Ray>& rays) {
  RayExtent extent;
  for (const Ray& ray : rays) {
    const glm::dvec3 away = ray.origin - from;
    extent = joined(extent, {glm::dot(away, away), ray.power, ray.power, ray.length, true});
  }
  return extent;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("extents are those found one by one, with every instruction set") {
    with_each_instruction_set([] {
      for (const std::size_t count : {1, 2, 3, 4, 5, 7, 8, 9, 100, 1001}) {
        CAPTURE(count);
        const auto discs = some_discs(count);
        const DiscExtent of_discs = extent_of(discs);
        const DiscExtent expected = one_by_one(discs);
        CHECK(of_discs.centres.low == expected.centres.low);
        CHECK(of_discs.centres.high == expected.centres.high);
        CHECK(of_discs.smallest == expected.smallest);
        CHECK(of_discs.largest == expected.largest);
        CHECK(of_discs.sound);
        const auto rays = some_rays(count);
        const RayExtent of_rays = extent_of(rays, from, power_limit);
        const RayExtent wanted = one_by_one(rays);
        CHECK(of_rays.farthest2 == wanted.farthest2);
        CHECK(of_rays.least_power == wanted.least_power);
        CHECK(of_rays.most_power == wanted.most_power);
        CHECK(of_rays.least_length == wanted.least_length);
        CHECK(of_rays.sound);
      }
    });
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("one disc that is not sound is seen wherever it is, with every instruction set") {
    with_each_instruction_set([] {
      for (std::size_t place = 0; place < 11; ++place) {
        CAPTURE(place);
        const auto sound_with = [place](const Disc& disc) {
          auto discs = some_discs(11);
          discs[place] = disc;
          return extent_of(discs).sound;
        };
        const Disc disc{.centre = {1, 2, 3}, .normal = {0, 0, 1}, .radius = 1};
        CHECK(sound_with(disc));
        for (int axis = 0; axis < 3; ++axis)
          for (const double bad : {not_a_number, infinity, -infinity, 1.1e100}) {
            Disc one = disc;
            one.centre[axis] = bad;
            CHECK_FALSE(sound_with(one));
            one = disc;
            one.normal[axis] = bad;
            CHECK_FALSE(sound_with(one));
          }
        for (const double bad : {not_a_number, infinity, 0.0, -1.0, 9e-101, 1.1e100}) {
          Disc one = disc;
          one.radius = bad;
          CHECK_FALSE(sound_with(one));
        }
        CHECK_FALSE(sound_with({{0, 0, 0}, {0, 0, 1 + 1.1e-12}, 1}));
      }
    });
  }

  TEST_CASE("one ray that is not sound is seen wherever it is, with every instruction set") {
    with_each_instruction_set([] {
      for (std::size_t place = 0; place < 11; ++place) {
        CAPTURE(place);
        const auto sound_with = [place](const Ray& ray) {
          auto rays = some_rays(11);
          rays[place] = ray;
          return extent_of(rays, from, power_limit).sound;
        };
        const Ray ray{.origin = {1, 2, 3}, .direction = {0, 1, 0}, .length = unbounded, .power = 0};
        CHECK(sound_with(ray));
        for (int axis = 0; axis < 3; ++axis)
          for (const double bad : {not_a_number, infinity, -infinity, 1.1e100}) {
            Ray one = ray;
            one.origin[axis] = bad;
            CHECK_FALSE(sound_with(one));
            one = ray;
            one.direction[axis] = bad;
            CHECK_FALSE(sound_with(one));
          }
        for (const double bad : {not_a_number, 0.0, -1.0, -infinity}) {
          Ray one = ray;
          one.length = bad;
          CHECK_FALSE(sound_with(one));
        }
        for (const double bad : {not_a_number, -1.0, 1.1e200, infinity}) {
          Ray one = ray;
          one.power = bad;
          CHECK_FALSE(sound_with(one));
        }
        CHECK_FALSE(sound_with({{0, 0, 0}, {0, 0, 0}, 1, 1}));
      }
    });
  }
}
