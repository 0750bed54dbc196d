#include "detp/model/vocabulary/workload.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>

#include "support/not_a_length.hpp"

using namespace detp;
using doctest::Approx;
using doctest::Contains;

namespace {

const Workload good = cube_workload(1000, 100, 0.01, 2);

/// The workload with one of its numbers changed.
Workload with(double Workload::*number, double value) {
  Workload w = good;
  w.*number = value;
  return w;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("the largest of m discs is, on average, of the class that the shares give it") {
    Workload w = good;
    CHECK(largest_radius(w) == w.disc_radius);
    CHECK(largest_radius(w, 7) == w.disc_radius);
    w.radii = {{4, 0.1}, {2, 0.3}, {1, 0.6}};
    CHECK(largest_radius(w) == 4);
    CHECK(largest_radius(w, 1) == Approx(0.4 + 0.6 + 0.6));
    CHECK(largest_radius(w, 2) == Approx((1 - 0.81) * 4 + (0.81 - 0.36) * 2 + 0.36));
    CHECK(largest_radius(w, 1e9) == Approx(4));
  }

  TEST_CASE("another radius scales all radii; the spheres grow with the largest disc") {
    Workload w = cube_workload(1000, 100, std::sqrt(2.5), 20);
    w.radii = {{2, 0.5}, {1, 0.5}};
    const Workload changed = with_disc_radius(w, 3 * w.disc_radius);
    CHECK(changed.disc_radius == 3 * w.disc_radius);
    CHECK(changed.radii[0].radius == Approx(6));
    CHECK(changed.radii[1].radius == Approx(3));
    CHECK(changed.sphere_radius == Approx(w.sphere_radius + 4));
    CHECK_NOTHROW(check(changed));
  }

  TEST_CASE("the workload of a cube: its sphere contains every disc whole") {
    const Workload w = cube_workload(1000, 100, 0.25, 2, 2.5);
    CHECK(w.rays == 1000);
    CHECK(w.samples == 100);
    CHECK(w.disc_radius == 0.25);
    CHECK(w.sphere_radius == Approx(std::sqrt(3.0) + 0.25).epsilon(1e-15));
    CHECK(w.sphere_radius == enclosing_radius(2, 0.25));
    CHECK(w.box == std::array<double, 3>{2, 2, 2});
    CHECK(w.dimension == 2.5);
    CHECK_NOTHROW(check(w));
  }

  TEST_CASE("samples fill a cube's volume, its faces, or an extent in between") {
    CHECK(sample_extent(cube_workload(1, 1, 0.1, 3, 3)) == Approx(27).epsilon(1e-14));
    CHECK(sample_extent(cube_workload(1, 1, 0.1, 3, 2)) == Approx(54).epsilon(1e-14));
    CHECK(sample_extent(cube_workload(1, 1, 0.1, 3, 2.5)) == Approx(std::sqrt(27.0 * 54)).epsilon(1e-14));
    CHECK(sample_extent(cube_workload(1, 1, 0.1, 3, 1.2)) == Approx(54).epsilon(1e-14));
    CHECK(sample_extent(with(&Workload::sample_extent, 5)) == 5);
  }

  TEST_CASE("neighbours in a grid of samples are one grid step apart, unless set otherwise") {
    CHECK(sample_distance(cube_workload(1, 1e6, 0.1, 3)) == Approx(0.03).epsilon(1e-14));
    CHECK(sample_distance(cube_workload(1, 600, 0.1, 3, 2)) == Approx(0.3).epsilon(1e-14));
    CHECK(sample_distance(with(&Workload::sample_distance, 7)) == 7);
  }

  TEST_CASE("the side of the scene is the longest of the box; a flat box has a small positive volume") {
    Workload w = good;
    w.box = {1, 5, 0};
    CHECK(scene_side(w) == 5);
    CHECK(sample_extent(w) == Approx(1 * 5 * 5e-6).epsilon(1e-14));
    w.dimension = 2;
    CHECK(sample_extent(w) == Approx(2 * 5).epsilon(1e-5));
    CHECK_NOTHROW(check(w));
  }

  TEST_CASE("numbers at the ends of their ranges are accepted") {
    CHECK_NOTHROW(check(with(&Workload::rays, 1)));
    CHECK_NOTHROW(check(with(&Workload::samples, 1e18)));
    CHECK_NOTHROW(check(with(&Workload::dimension, 1)));
    CHECK_NOTHROW(check(with(&Workload::dimension, 3)));
    CHECK_NOTHROW(check(with(&Workload::path_length, 0)));
    CHECK_NOTHROW(check(with(&Workload::disc_radius, 1e300)));
    CHECK_NOTHROW(check(with(&Workload::sample_extent, 1e270)));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("classes of radii that contradict each other or d are refused") {
    const auto refused = [](std::vector<RadiusClass> radii, const char* why) {
      Workload w = cube_workload(1000, 100, std::sqrt(2.5), 20);
      w.radii = std::move(radii);
      CHECK_THROWS_WITH_AS(check(w), Contains(why), std::invalid_argument);
    };
    refused({{1, 0.5}, {2, 0.5}}, "must begin with the largest radius");
    refused({{2, 0.5}, {1, 0.4}}, "must add up to 1 (got 0.9)");
    refused({{3, 0.5}, {1, 0.5}}, "root mean square of the classes of radii (got 1.58");
    refused({{2, 0.5}, {-1, 0.5}}, "radius of a class of discs must be > 0");
    refused({{2, 1.5}, {1, -0.5}}, "share of a class of discs must be > 0");
  }

  TEST_CASE("each number out of its range is refused by name") {
    for (const double bad : support::not_a_count) {
      CHECK_THROWS_WITH_AS(check(with(&Workload::rays, bad)), Contains("number of rays"), std::invalid_argument);
      CHECK_THROWS_WITH_AS(check(with(&Workload::samples, bad)), Contains("number of samples"), std::invalid_argument);
    }
    for (const double bad : support::not_a_length) {
      CHECK_THROWS_WITH_AS(check(with(&Workload::disc_radius, bad)), Contains("disc radius"), std::invalid_argument);
      CHECK_THROWS_WITH_AS(check(with(&Workload::sphere_radius, bad)), Contains("sphere radius"),
                           std::invalid_argument);
    }
    for (const double bad : support::not_a_dimension)
      CHECK_THROWS_WITH_AS(check(with(&Workload::dimension, bad)), Contains("sample dimension"), std::invalid_argument);
    for (const double bad : support::not_a_size) {
      CHECK_THROWS_WITH_AS(check(with(&Workload::sample_extent, bad)), Contains("sample extent"),
                           std::invalid_argument);
      CHECK_THROWS_WITH_AS(check(with(&Workload::sample_distance, bad)), Contains("sample distance"),
                           std::invalid_argument);
      CHECK_THROWS_WITH_AS(check(with(&Workload::path_length, bad)), Contains("path length"), std::invalid_argument);
      for (const std::size_t axis : {0u, 1u, 2u}) {
        Workload w = good;
        w.box[axis] = bad;
        CHECK_THROWS_WITH_AS(check(w), Contains("side of the sample box"), std::invalid_argument);
      }
    }
  }

  TEST_CASE("an extent beyond all boxes is refused by name") {
    CHECK_THROWS_WITH_AS(check(with(&Workload::sample_extent, 1.1e270)), Contains("sample extent"),
                         std::invalid_argument);
  }

  TEST_CASE("a box without any side is refused, and so is a workload that is not filled in") {
    Workload w = good;
    w.box = {0, 0, 0};
    CHECK_THROWS_WITH_AS(check(w), Contains("longest side of the sample box"), std::invalid_argument);
    CHECK_THROWS_AS(check(Workload{}), std::invalid_argument);
  }
}
