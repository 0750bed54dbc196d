#include "detp/model/lines/directed_rays.hpp"

#include <doctest/doctest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <limits>
#include <numbers>

using namespace detp;
using namespace detp::model;
using doctest::Approx;
using std::numbers::pi;

namespace {

/// By quadrature in polar coordinates around the disc's centre. The inner integral is over the angle.
double solid_angle_by_quadrature(double radius, double height, double offset) {
  using Quadrature = boost::math::quadrature::gauss_kronrod<double, 61>;
  const auto ring = [&](double r) {
    const auto part = [&](double angle) {
      const double squared = height * height + r * r + offset * offset - 2 * r * offset * std::cos(angle);
      return height / (squared * std::sqrt(squared));
    };
    return r * 2 * Quadrature::integrate(part, 0.0, pi, 15, 1e-12);
  };
  return Quadrature::integrate(ring, 0.0, radius, 15, 1e-12);
}

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("the solid angle of a disc is that of quadrature, near and far, beside and above") {
    for (const double radius : {0.5, 2.0})
      for (const double height : {0.1, 0.5, 2.0, 30.0})
        for (const double offset : {0.0, 0.3, 0.5, 1.9, 2.0, 7.0}) {
          CAPTURE(radius);
          CAPTURE(height);
          CAPTURE(offset);
          CHECK(disc_solid_angle(DiscRadius{radius}, {height, offset}) ==
                Approx(solid_angle_by_quadrature(radius, height, offset)).epsilon(1e-9));
        }
  }
}

TEST_SUITE("limit") {
  TEST_CASE("the series far away joins the closed form") {
    for (const double slope : {0.0, 0.5, 1.0, 1.5}) {
      const double height = std::cos(slope), offset = std::sin(slope);
      const double near = disc_solid_angle(DiscRadius{1}, {299.999 * height, 299.999 * offset});
      const double far = disc_solid_angle(DiscRadius{1}, {300.001 * height, 300.001 * offset});
      CHECK(far / near == Approx(std::pow(299.999 / 300.001, 2)).epsilon(1e-8));
    }
  }

  TEST_CASE("a point in the plane sees half of space inside the disc, a quarter on its rim, nothing beside it") {
    CHECK(disc_solid_angle(DiscRadius{2}, {0, 1}) == Approx(2 * pi));
    CHECK(disc_solid_angle(DiscRadius{2}, {0, 2}) == Approx(pi));
    CHECK(disc_solid_angle(DiscRadius{2}, {0, 3}) == 0);
    CHECK(disc_solid_angle(DiscRadius{2}, {1e-9, 1}) == Approx(2 * pi).epsilon(1e-8));
    CHECK(disc_solid_angle(DiscRadius{2}, {1e-9, 2}) == Approx(pi).epsilon(1e-6));
    CHECK(disc_solid_angle(DiscRadius{2}, {0, 0}) == Approx(2 * pi));
  }

  TEST_CASE("near the rim the limit of the elliptic integrals joins them") {
    for (const double angle : {0.1, 0.7, 1.5}) {
      const auto at = [&](double distance) {
        return disc_solid_angle(DiscRadius{1}, {distance * std::sin(angle), 1 + distance * std::cos(angle)});
      };
      // across the switch at k' = 1e-3 it changes by next to nothing
      CHECK(at(1.9999e-3) == Approx(at(2.0001e-3)).epsilon(1e-6));
      CHECK(at(1e-9) == Approx(2 * angle).epsilon(1e-6));
    }
  }

  TEST_CASE("on the axis the solid angle is that of a cone; far away it is area over distance squared, at any scale") {
    for (const double height : {0.01, 1.0, 100.0, 299.0})
      CHECK(disc_solid_angle(DiscRadius{1}, {height, 0}) ==
            Approx(2 * pi / (height * height + 1) / (1 + height / std::hypot(1, height))).epsilon(1e-10));
    for (const double scale : {1e-150, 1e-12, 1.0, 1e12, 1e150})
      CHECK(disc_solid_angle(DiscRadius{scale}, {1e6 * scale, 0}) == Approx(pi * 1e-12).epsilon(1e-11));
    CHECK(disc_solid_angle(DiscRadius{1}, {1e140, 1e140}) == Approx(pi / std::sqrt(8.0) * 1e-280));
  }

  TEST_CASE(
      "the mean of |cos| over isotropic directions gives the isotropic probability; a far point is parallel light") {
    const DiscRadius disc{0.1};
    const SphereRadius outer{2};
    CHECK(parallel_disc_hit_probability(disc, outer, 0.5) == Approx(0.01 / 8));
    CHECK(parallel_disc_hit_probability(disc, outer, -1) == Approx(0.01 / 4));
    const double distance = 1e6;
    CHECK(point_disc_hit_probability(disc, {distance * 0.6, distance * 0.8}, outer, distance) ==
          Approx(parallel_disc_hit_probability(disc, outer, 0.6)).epsilon(1e-9));
  }

  TEST_CASE("a sphere fills all directions from inside, half of them on its surface at the limit, few from afar") {
    CHECK(sphere_solid_angle(SphereRadius{2}, 1) == Approx(4 * pi));
    CHECK(sphere_solid_angle(SphereRadius{2}, 2 * (1 + 1e-15)) == Approx(2 * pi).epsilon(1e-6));
    CHECK(sphere_solid_angle(SphereRadius{1}, 1e8) == Approx(pi * 1e-16).epsilon(1e-12));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("radii, heights, offsets and cosines out of range are refused") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS((void)disc_solid_angle(DiscRadius{0}, {1, 1}), std::invalid_argument);
    CHECK_THROWS_AS((void)disc_solid_angle(DiscRadius{1}, {-1, 1}), std::invalid_argument);
    CHECK_THROWS_AS((void)disc_solid_angle(DiscRadius{1}, {1, nan}), std::invalid_argument);
    CHECK_THROWS_AS((void)sphere_solid_angle(SphereRadius{-1}, 1), std::invalid_argument);
    CHECK_THROWS_AS((void)sphere_solid_angle(SphereRadius{1}, nan), std::invalid_argument);
    CHECK_THROWS_AS((void)parallel_disc_hit_probability(DiscRadius{0.1}, SphereRadius{1}, 1.1), std::invalid_argument);
    CHECK_THROWS_AS((void)parallel_disc_hit_probability(DiscRadius{2}, SphereRadius{1}, 1), std::invalid_argument);
    CHECK_THROWS_AS((void)parallel_disc_hit_probability(DiscRadius{0.1}, SphereRadius{1}, nan), std::invalid_argument);
  }
}
