#include "detp/sim/rays/mixed_field.hpp"

#include <doctest/doctest.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "detp/model/lines/line_measure.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/technique/technique.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

constexpr Sphere the_ball{{1, 2, 3}, 2};

std::vector<Ray> rays_of(const FieldMixture& mixture, std::uint64_t count, std::uint64_t seed = 1) {
  std::vector<Ray> rays(count);
  MixedField(mixture, seed, count).read(0, rays);
  return rays;
}

/// At random places inside the the_ball.
std::vector<Disc> discs_inside(std::size_t count, double radius) {
  std::vector<Disc> discs;
  for (std::uint64_t i = 0; discs.size() < count; ++i) {
    const auto place = uniform4(7, Stream::tests, i);
    const auto turn = uniform4(8, Stream::tests, i);
    const glm::dvec3 centre = 2.0 * glm::dvec3{place[0], place[1], place[2]} - 1.0;
    if (glm::length(centre) * the_ball.radius + radius < the_ball.radius)
      discs.push_back({the_ball.centre + the_ball.radius * centre, uniform_direction(turn[0], turn[1]), radius});
  }
  return discs;
}

/// Of a disc, seen from a point at this height over its plane and this distance from its axis: by quadrature in polar
/// coordinates around the disc's centre. The inner integral is over the angle.
double solid_angle(double radius, double height, double offset) {
  using Quadrature = boost::math::quadrature::gauss_kronrod<double, 61>;
  const auto ring = [&](double r) {
    const auto part = [&](double angle) {
      const double squared = height * height + r * r + offset * offset - 2 * r * offset * std::cos(angle);
      return height / (squared * std::sqrt(squared));
    };
    return r * 2 * Quadrature::integrate(part, 0.0, std::numbers::pi, 10, 1e-8);
  };
  return Quadrature::integrate(ring, 0.0, radius, 10, 1e-8);
}

/// Of a sphere, seen from a point at this distance from its centre.
double solid_angle_of_sphere(double radius, double distance) {
  if (distance <= radius) return 4 * std::numbers::pi;
  return 2 * std::numbers::pi * (1 - std::sqrt(1 - radius * radius / (distance * distance)));
}

/// Isotropic lines hit by the measure of lines; parallel ones by the area that the disc turns to them; segments from a point
/// by the disc's solid angle over the sphere's.
double hit_probability(const FieldMixture& mixture, const Disc& disc) {
  const DiscRadius radius{disc.radius};
  const SphereRadius outer{mixture.sphere.radius};
  const glm::dvec3 to = mixture.point - disc.centre;
  const double height = std::abs(glm::dot(to, disc.normal));
  const double offset = glm::length(to - glm::dot(to, disc.normal) * disc.normal);
  const double cosine = glm::dot(glm::normalize(mixture.direction), disc.normal);
  const double isotropic = model::disc_hit_probability(radius, outer);
  const double distance = glm::distance(mixture.point, mixture.sphere.centre);
  return mixture.shares.isotropic * isotropic + mixture.shares.directional * 2 * std::abs(cosine) * isotropic +
         mixture.shares.point * solid_angle(disc.radius, height, offset) /
             solid_angle_of_sphere(mixture.sphere.radius, distance);
}

/// Whether the hits of all discs are what chance explains; false once in 10⁶ times. `scale` multiplies the prediction.
bool hits_agree(const FieldMixture& mixture, double scale = 1) {
  constexpr std::uint64_t count = 1'000'000;
  const std::vector<Ray> rays = rays_of(mixture, count);
  const std::vector<Disc> discs = discs_inside(50, 0.3);
  const Outcome outcome =
      run(make_problem(rays, discs, false, 2), Candidate{Technique::brute_force, BruteForceParameters{}});
  double squares = 0;
  for (std::size_t i = 0; i < discs.size(); ++i) {
    const double p = scale * hit_probability(mixture, discs[i]);
    squares += std::pow(static_cast<double>(outcome.hits[i]) - count * p, 2) / (count * p * (1 - p));
  }
  return cdf(complement(boost::math::chi_squared(50), squares)) > 1e-6;
}

}  // namespace

TEST_SUITE("statistical") {
  TEST_CASE("segments from a point outside fill the cone to the sphere, up to its edge") {
    const FieldMixture mixture{.sphere = the_ball, .shares = {0, 0, 1}, .point = {1, 7, 3}};
    const double edge = std::sqrt(1 - std::pow(2.0 / 5, 2));
    double least = 1;
    for (const Ray& ray : rays_of(mixture, 20'000)) least = std::min(least, -ray.direction.y);
    CHECK(least >= edge - 1e-14);
    CHECK(1 - least > 0.999 * (1 - edge));
  }

  TEST_CASE("each disc of each mixture is hit as often as the closed forms say") {
    const glm::dvec3 inside = the_ball.centre + glm::dvec3{0.3, 1.2, -0.5};
    const glm::dvec3 outside = the_ball.centre + glm::dvec3{0, 9, 2};
    for (const glm::dvec3& point : {inside, outside})
      for (const FieldShares& shares : {FieldShares{0, 1, 0}, FieldShares{0, 0, 1}, FieldShares{0.5, 0.3, 0.2}}) {
        const FieldMixture mixture{the_ball, shares, {1, -3, 0.5}, point};
        CHECK(hits_agree(mixture));
        CHECK_FALSE(hits_agree(mixture, 1.02));
      }
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("every stretch of rays has its share of each kind; segments start at the point and end on the sphere") {
    const FieldMixture mixture{the_ball, {0.5, 0.25, 0.25}, {0, -1, 0}, {1, 3, 3}};
    const std::vector<Ray> rays = rays_of(mixture, 4096);
    for (std::size_t first = 0; first < rays.size(); first += 256) {
      int parallel = 0;
      int segments = 0;
      for (std::size_t i = first; i < first + 256; ++i) {
        if (!rays[i].is_line()) {
          ++segments;
          CHECK(rays[i].origin == mixture.point);
          const glm::dvec3 end = rays[i].origin + rays[i].length * rays[i].direction;
          CHECK(glm::distance(end, the_ball.centre) == doctest::Approx(the_ball.radius).epsilon(1e-12));
        } else if (rays[i].direction == glm::dvec3{0, -1, 0}) {
          ++parallel;
        }
      }
      CHECK(parallel == 64);
      CHECK(segments == 64);
    }
  }
}

TEST_SUITE("identity") {
  TEST_CASE("lines alone have the bytes of LineField; blocks and one read give the same bytes") {
    const FieldMixture lines{the_ball, {1, 0, 0}, {0, -1, 0}, {1, 3, 3}};
    const std::vector<Ray> mixed = rays_of(lines, 1000, 5);
    const std::vector<Ray> plain = LineField(the_ball, 5).lines(0, 1000);
    CHECK(std::memcmp(mixed.data(), plain.data(), mixed.size() * sizeof(Ray)) == 0);
    const MixedField source({the_ball, {0.4, 0.3, 0.3}, {0, -1, 0}, {1, 3, 3}}, 5, 1000);
    std::vector<Ray> whole(1000), parts(1000);
    source.read(0, whole);
    for (std::size_t first = 0; first < 1000; first += 300)
      source.read(first, std::span(parts).subspan(first, std::min<std::size_t>(300, 1000 - first)));
    CHECK(std::memcmp(whole.data(), parts.data(), whole.size() * sizeof(Ray)) == 0);
    for (const Ray& ray : whole)
      CHECK(glm::distance(ray.origin, the_ball.centre) <= source.farthest_from(the_ball.centre));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("shares that do not add up, no direction, and points on the sphere or not finite are refused") {
    const auto refuses = [](const FieldMixture& mixture, const char* message) {
      CHECK_THROWS_WITH_AS(MixedField(mixture, 1, 1), doctest::Contains(message), std::invalid_argument);
    };
    refuses({the_ball, {0.5, 0.4, 0}, {0, 1, 0}, {1, 2, 3}}, "must add up to 1");
    refuses({the_ball, {1.5, -0.5, 0}, {0, 1, 0}, {1, 2, 3}}, "share of a kind of rays");
    refuses({the_ball, {1, 0, 0}, {0, 0, 0}, {1, 2, 3}}, "must not be zero");
    refuses({the_ball, {1, 0, 0}, {0, 1, 0}, {1, 4, 3}}, "must not lie on the sphere");
    refuses({the_ball, {1, 0, 0}, {0, 1, 0}, {std::numeric_limits<double>::quiet_NaN(), 4, 3}}, "must be finite");
    refuses({{{0, 0, 0}, 0}, {1, 0, 0}, {0, 1, 0}, {1, 4, 3}}, "sphere radius");
  }
}
