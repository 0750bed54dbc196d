#include "detp/sim/scene/vertices.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

using namespace detp;
using namespace detp::sim;

namespace {

struct Found {
  Mesh mesh;
  std::vector<Sample> samples;
  Notices notices;
};

Found found(Mesh mesh, double crease = default_crease) {
  Notices notices;
  std::vector<Sample> samples = samples_at_vertices(mesh, crease, notices);
  return {std::move(mesh), std::move(samples), std::move(notices)};
}

bool is_near(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-14; }

std::vector<std::array<double, 6>> rows_of(const std::vector<Sample>& samples) {
  std::vector<std::array<double, 6>> rows;
  for (const auto& [p, n, vertex] : samples) rows.push_back({p.x, p.y, p.z, n.x, n.y, n.z});
  std::ranges::sort(rows);
  return rows;
}

const std::vector<std::array<std::uint32_t, 4>> faces_of_cube{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                                              {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

/// Faces outwards. A diagonal starts at a face's corner `first`.
Mesh cube(double side, std::size_t first = 0) {
  Mesh mesh{.positions = {{0, 0, 0},
                          {side, 0, 0},
                          {side, side, 0},
                          {0, side, 0},
                          {0, 0, side},
                          {side, 0, side},
                          {side, side, side},
                          {0, side, side}},
            .normals = {},
            .triangles = {}};
  for (const auto& face : faces_of_cube) {
    const auto at = [&](std::size_t i) { return face[(first + i) % 4]; };
    mesh.triangles.push_back({at(0), at(1), at(2)});
    mesh.triangles.push_back({at(0), at(2), at(3)});
  }
  return mesh;
}

/// The same, each triangle with corners of its own.
Mesh repeated(const Mesh& mesh) {
  Mesh own{.positions = {}, .normals = {}, .triangles = {}};
  for (const auto& triangle : mesh.triangles) {
    const auto next = static_cast<std::uint32_t>(own.positions.size());
    for (const std::uint32_t corner : triangle) own.positions.push_back(mesh.positions[corner]);
    own.triangles.push_back({next, next + 1, next + 2});
  }
  return own;
}

/// Two unit squares that share an edge, folded by so many degrees.
Mesh folded(double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  const double x = std::cos(angle);
  const double z = std::sin(angle);
  return {.positions = {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {-1, 1, 0}, {x, 0, z}, {x, 1, z}},
          .normals = {},
          .triangles = {{0, 1, 3}, {0, 3, 2}, {0, 4, 5}, {0, 5, 1}}};
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("a cube has three samples at each corner, whatever its indexing, its diagonals and its size") {
    for (const double side : {1.0, 3e-13, 7e12, 1e-160, 1e160, 1e-300, 1e300}) {
      CAPTURE(side);
      const auto shared = rows_of(found(cube(side)).samples);
      REQUIRE(shared.size() == 24);
      for (const auto& row : shared) CHECK(std::abs(row[3]) + std::abs(row[4]) + std::abs(row[5]) == 1);
      CHECK(rows_of(found(cube(side, 1)).samples) == shared);
      CHECK(rows_of(found(repeated(cube(side))).samples) == shared);
      CHECK(rows_of(found(repeated(cube(side, 3))).samples) == shared);
    }
  }

  TEST_CASE("the normals of a mesh rule, and equal pairs of position and normal are one vertex") {
    Mesh mesh = repeated(cube(1));
    for (const auto& triangle : mesh.triangles) {
      const glm::dvec3 a = mesh.positions[triangle[0]];
      const glm::dvec3 normal = glm::cross(mesh.positions[triangle[1]] - a, mesh.positions[triangle[2]] - a);
      mesh.normals.insert(mesh.normals.end(), 3, 5.0 * normal);
    }
    CHECK(rows_of(found(mesh).samples) == rows_of(found(cube(1)).samples));
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) mesh.normals[i] = mesh.positions[i] - glm::dvec3(0.5);
    const Found smooth = found(mesh);
    CHECK(smooth.samples.size() == 8);
    CHECK(smooth.mesh.positions.size() == 8);
    CHECK(is_near(smooth.samples[0].normal, glm::normalize(smooth.samples[0].position - glm::dvec3(0.5))));
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("vertices come in the order of the file's, then of their first face, and know the file's number") {
    const Found all = found(repeated(cube(1)));
    REQUIRE(all.samples.size() == 24);
    CHECK(std::ranges::is_sorted(all.samples, {}, &Sample::vertex));
    CHECK(all.samples[0].position == all.mesh.positions[0]);
    CHECK(all.samples[0].normal == glm::dvec3{0, 0, -1});
    const Found shared = found(cube(1));
    for (std::uint32_t i = 0; i < 24; ++i) CHECK(shared.samples[i].vertex == i / 3);
    CHECK(shared.samples[1].normal == glm::dvec3{0, -1, 0});
    CHECK(shared.samples[2].normal == glm::dvec3{-1, 0, 0});
  }

  TEST_CASE("faces that meet below the crease angle share the mean normal by angle, others have their own") {
    for (const double degrees : {10.0, 45.0, 49.0}) {
      const Found smooth = found(folded(degrees));
      REQUIRE(smooth.samples.size() == 6);
      const double half = degrees * std::numbers::pi / 360;
      CHECK(is_near(smooth.samples[0].normal, {-std::sin(half), 0, std::cos(half)}));
      CHECK(is_near(smooth.samples[1].normal, {-std::sin(half), 0, std::cos(half)}));
    }
    CHECK(found(folded(51)).samples.size() == 8);
    CHECK(found(folded(51), 60).samples.size() == 6);
    CHECK(found(folded(10), 5).samples.size() == 8);
    CHECK(found(folded(10), 0).samples.size() == 8);
    CHECK(found(folded(179), 180).samples.size() == 6);
    CHECK(found(cube(1), 180).samples.size() == 8);
    CHECK(is_near(found(cube(1), 180).samples[0].normal, glm::normalize(glm::dvec3(-1))));
  }

  TEST_CASE("where the normals of a group cancel, it has that of its largest triangle") {
    const Mesh leaf{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .normals = {}, .triangles = {{0, 1, 2}, {0, 2, 1}}};
    const Found joined = found(leaf, 180);
    REQUIRE(joined.samples.size() == 3);
    for (const Sample& sample : joined.samples) CHECK(sample.normal == glm::dvec3{0, 0, 1});
  }

  TEST_CASE("the mesh's own normals are used, scaled to length 1, and those of the triangles in place of zero") {
    Mesh mesh = folded(0);
    mesh.normals = {{0, 0, 3}, {1e-300, 0, 0}, {0, 1e300, 0}, {0, 0, 0}, {1, 1, 0}, {0, 0, 0}};
    const auto samples = found(mesh).samples;
    REQUIRE(samples.size() == 6);
    CHECK(samples[0].normal == glm::dvec3{0, 0, 1});
    CHECK(samples[1].normal == glm::dvec3{1, 0, 0});
    CHECK(samples[2].normal == glm::dvec3{0, 1, 0});
    CHECK(samples[3].normal == glm::dvec3{0, 0, 1});
    CHECK(samples[5].normal == glm::dvec3{0, 0, 1});
  }

  TEST_CASE("unreferenced vertices and those whose triangles have no area are dropped, with a count of each kind") {
    Mesh mesh = folded(0);
    const double third = 1.0 / 3;
    for (const glm::dvec3& position :
         {glm::dvec3{9}, glm::dvec3{9}, {5, 5, 5}, {5 + third, 5 + third, 5 + third}, {6, 6, 6}})
      mesh.positions.push_back(position);
    mesh.triangles.push_back({8, 9, 10});  // collinear within rounding
    mesh.triangles.push_back({8, 8, 8});
    mesh.triangles.push_back({0, 1, 1});
    const Found some = found(mesh);
    CHECK(some.samples.size() == 6);
    CHECK(some.notices == Notices{"3 vertices dropped: no triangle around has an area"});
    Notices notices;
    note_unreferenced(mesh, notices);
    note_unreferenced(some.mesh, notices);
    CHECK(notices == Notices{"2 unreferenced vertices dropped"});
    CHECK(some.mesh.triangles.size() == 7);
  }

  TEST_CASE("the normal of a needle 1e7 times as long as wide is right to 1e-8") {
    const Mesh needle{.positions = {{0.1, 0.2, 0.3}, {1.1, 0.2, 0.3}, {0.6, 0.2 + 1e-7, 0.3}},
                      .normals = {},
                      .triangles = {{0, 1, 2}}};
    CHECK(glm::length(found(needle).samples[0].normal - glm::dvec3{0, 0, 1}) < 1e-8);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a crease angle out of range is refused") {
    for (const double crease : {-1.0, 181.0, std::nan("")}) {
      Mesh mesh = folded(0);
      Notices notices;
      CHECK_THROWS_AS((void)samples_at_vertices(mesh, crease, notices), std::invalid_argument);
    }
  }
}
