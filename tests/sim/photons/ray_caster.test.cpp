#include "detp/sim/photons/ray_caster.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"
#include "support/boxes.hpp"

using namespace detp::sim;
using detp::support::box_of;

namespace {

glm::dvec3 random_point(std::uint64_t index, std::uint64_t sub_index) {
  const auto random = uniform4(1, Stream::tests, index, sub_index);
  return {2 * random[0] - 1, 2 * random[1] - 1, 2 * random[2] - 1};
}

/// Triangles of about that size at random places in [-1, 1]³.
Mesh random_triangles(std::uint64_t count, double size) {
  Mesh mesh;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    const glm::dvec3 corner = (1 - size) * random_point(i, 0);
    for (const glm::dvec3& p : {corner, corner + size * random_point(i, 1), corner + size * random_point(i, 2)})
      mesh.positions.push_back(p);
    mesh.triangles.push_back({base, base + 1, base + 2});
  }
  return mesh;
}

/// Six times the volume between four points.
double volume(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
  return glm::dot(b - a, glm::cross(c - a, d - a));
}

struct Found {
  double distance = unbounded;
  std::size_t triangle = 0;
};

/// Tests all triangles by signed volumes: an independent method.
Found first_by_volumes(const Mesh& mesh, const glm::dvec3& origin, const glm::dvec3& direction) {
  Found found;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [ia, ib, ic] = mesh.triangles[i];
    const glm::dvec3 &a = mesh.positions[ia], &b = mesh.positions[ib], &c = mesh.positions[ic];
    const glm::dvec3 ahead = origin + direction;
    const bool ab = volume(origin, ahead, a, b) > 0;
    if (ab != (volume(origin, ahead, b, c) > 0) || ab != (volume(origin, ahead, c, a) > 0)) continue;
    const double here = volume(a, b, c, origin);
    const double distance = here / (here - volume(a, b, c, ahead));
    if (distance > 0 && distance < found.distance) found = {distance, i};
  }
  return found;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("repeated triangles are met as if each were there once, under the number of the first") {
    const Mesh once = random_triangles(50, 1.0);
    Mesh often;
    often.positions = once.positions;
    for (int copy = 0; copy < 2000; ++copy)
      for (const auto& [a, b, c] : once.triangles) {
        if (copy > 0)
          often.triangles.push_back(copy % 2 == 0 ? std::array{b, c, a} : std::array{c, b, a});
        else
          often.triangles.push_back({a, b, c});
      }
    often.triangles.insert(often.triangles.begin() + 50, 100'000, {0, 0, 1});  // without area
    const RayCaster caster(often, box_of(often));
    const RayCaster truth(once, box_of(once));
    for (std::uint64_t i = 0; i < 500; ++i) {
      const auto random = uniform4(1, Stream::tests, i, 7);
      const glm::dvec3 origin = caster.to_caster(random_point(i, 5));
      const glm::dvec3 direction = uniform_direction(random[0], random[1]);
      const auto expected = truth.first_intersection(origin, direction);
      const auto met = caster.first_intersection(origin, direction);
      REQUIRE(met.has_value() == expected.has_value());
      if (!met) continue;
      CHECK(met->distance == doctest::Approx(expected->distance).epsilon(1e-12));
      const auto number = met->triangle < 50 ? met->triangle : (met->triangle - 100'000) % 50;
      CHECK(number == expected->triangle);
    }
  }

  TEST_CASE("it meets the same triangle as a search of all of them, at the same distance, for all sizes") {
    for (const double size : {1.0, 0.1, 1e-3}) {
      CAPTURE(size);
      const Mesh mesh = random_triangles(2000, size);
      const RayCaster caster(mesh, box_of(mesh));
      std::size_t met = 0;
      std::size_t wrong = 0;
      for (std::uint64_t i = 0; i < 2000; ++i) {
        const glm::dvec3 origin = 3.0 * random_point(i, 3);
        const glm::dvec3 aim =
            mesh.positions[3 * i] * 0.5 + mesh.positions[3 * i + 1] * 0.3 + mesh.positions[3 * i + 2] * 0.2;
        const glm::dvec3 direction = glm::normalize(aim - origin);
        const auto intersection = caster.first_intersection(caster.to_caster(origin), direction);
        const Found expected = first_by_volumes(mesh, origin, direction);
        if (expected.distance < unbounded) ++met;
        if (!intersection || intersection->triangle != expected.triangle ||
            std::abs(intersection->distance * caster.scale() - expected.distance) > 1e-9)
          ++wrong;
      }
      CHECK(met == 2000);
      CHECK(wrong == 0);
    }
  }

  TEST_CASE("it misses triangles behind or beside the ray, and triangles without area") {
    Mesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 2, 0}}, .normals = {}, .triangles = {{0, 1, 2}}};
    const RayCaster caster(mesh, box_of(mesh));
    const auto meets = [&](const RayCaster& by, const glm::dvec3& origin, const glm::dvec3& direction) {
      return by.first_intersection(by.to_caster(origin), direction).has_value();
    };
    CHECK(meets(caster, {0.25, 0.25, 1}, {0, 0, -1}));
    CHECK(meets(caster, {0.25, 0.25, 1e6}, {0, 0, -1}));
    CHECK_FALSE(meets(caster, {0.25, 0.25, 1}, {0, 0, 1}));
    CHECK_FALSE(meets(caster, {0.75, 0.75, 1}, {0, 0, -1}));
    CHECK_FALSE(meets(caster, {-1, 0.25, 0}, {1, 0, 0}));
    mesh.triangles = {{0, 3, 3}, {0, 0, 0}};
    const RayCaster nothing(mesh, box_of(mesh));
    CHECK_FALSE(meets(nothing, {0.5, 0.5, 1}, {0, 0, -1}));
  }

  TEST_CASE("of triangles at the same distance the one with the lowest number is hit") {
    Mesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}}, .normals = {}, .triangles = {}};
    for (int i = 0; i < 100; ++i) mesh.triangles.push_back({0, 1, 2});
    const RayCaster caster(mesh, box_of(mesh));
    const auto intersection = caster.first_intersection(caster.to_caster({0.25, 0.25, 1}), {0, 0, -1});
    REQUIRE(intersection);
    CHECK(intersection->triangle == 0);
  }

  TEST_CASE("a ray that starts on a plane hits neither its own triangle nor neighbours in the plane") {
    const glm::dvec3 u = glm::normalize(glm::dvec3{1, 0.3, -0.2});
    const glm::dvec3 v = glm::normalize(glm::cross(u, glm::dvec3{0.1, 1, 0.7}));
    Mesh mesh{.positions = {glm::dvec3{0.0}, u, u + v, v}, .normals = {}, .triangles = {{0, 1, 2}, {0, 2, 3}}};
    const RayCaster caster(mesh, box_of(mesh));
    const glm::dvec3 normal = glm::cross(u, v);
    std::size_t met = 0;
    for (std::uint64_t i = 0; i < 10'000; ++i) {
      const auto random = uniform4(2, Stream::tests, i);
      const glm::dvec3 start = caster.to_caster(random[0] * u + random[1] * v);
      const std::uint32_t from = random[1] < random[0] ? 0 : 1;
      if (caster.first_intersection(start, cosine_direction(normal, random[2], random[3]), from)) ++met;
    }
    CHECK(met == 0);
  }
}
