#include "detp/sim/scene/coincident.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <functional>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/scene/built_in/mesh_pieces.hpp"
#include "support/flat_meshes.hpp"

using namespace detp::sim;
using namespace detp::support;

namespace {

/// Adds triangles with corners in the plane z = height.
void add_flat(Mesh& mesh, std::initializer_list<std::array<Corner, 3>> triangles, double height = 0) {
  for (const auto& triangle : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const auto& [x, y] : triangle) mesh.positions.push_back({x, y, height});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
}

void move(Mesh& mesh, const std::function<glm::dvec3(const glm::dvec3&)>& to) {
  for (glm::dvec3& position : mesh.positions) position = to(position);
}

/// Moves a mesh so that the plane z = 0 becomes another plane.
std::function<glm::dvec3(const glm::dvec3&)> into_plane(std::uint64_t number) {
  const auto random = uniform4(31, Stream::tests, number);
  const glm::dvec3 normal = uniform_direction(random[0], random[1]);
  const auto [first, second] = basis_around(normal);
  const glm::dvec3 origin{random[2], random[3], random[2] - random[3]};
  return [u = first, v = second, normal, origin](const glm::dvec3& at) {
    return origin + at.x * u + at.y * v + at.z * normal;
  };
}

/// Of the union of triangles of the plane z = 0, along the line at x.
double length_of_union_at(const Mesh& mesh, double x) {
  std::vector<std::array<double, 2>> parts;
  for (const auto& triangle : mesh.triangles) {
    double low = 1e300;
    double high = -1e300;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec3& a = mesh.positions[triangle[i]];
      const glm::dvec3& b = mesh.positions[triangle[(i + 1) % 3]];
      if ((a.x < x) == (b.x < x)) continue;
      const double y = a.y + (x - a.x) / (b.x - a.x) * (b.y - a.y);
      low = std::min(low, y);
      high = std::max(high, y);
    }
    if (low < high) parts.push_back({low, high});
  }
  std::sort(parts.begin(), parts.end());
  double sum = 0;
  double end = -1e300;
  for (const auto& [low, high] : parts) {
    sum += std::max(0.0, high - std::max(low, end));
    end = std::max(end, high);
  }
  return sum;
}

/// Of a mesh in the unit square of the plane.
double area_of_union(const Mesh& mesh) {
  constexpr int lines = 20000;
  double sum = 0;
  for (int i = 0; i < lines; ++i) sum += length_of_union_at(mesh, (i + 0.5) / lines);
  return sum / lines;
}

Mesh random_triangles(std::uint64_t number, std::uint32_t count) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      const auto random = uniform4(32, Stream::tests, number, 3 * i + corner);
      mesh.positions.push_back({random[0], random[1], 0});
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("the same face again, turned, or from another corner, vanishes") {
    const Mesh once = unit_square();
    for (const std::array<std::uint32_t, 3>& order :
         {std::array<std::uint32_t, 3>{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}})
      for (const bool first : {false, true}) {
        Mesh mesh = once;
        for (const auto& corners : once.triangles) {
          const std::array again{corners[order[0]], corners[order[1]], corners[order[2]]};
          mesh.triangles.insert(first ? mesh.triangles.begin() : mesh.triangles.end(), again);
        }
        const Mesh after = joined(mesh);
        CHECK(area_of(after) == 1);
        CHECK(after.coincident == 2);
        CHECK(after.positions == mesh.positions);
        CHECK(std::equal(after.triangles.begin(), after.triangles.end(), mesh.triangles.begin()));
      }
  }

  TEST_CASE("faces with corners of their own, and zeros of other signs, are the same") {
    Mesh mesh = unit_square();
    for (const glm::dvec3& position : unit_square().positions)
      mesh.positions.push_back(position * glm::dvec3{1, 1, -1});
    for (const auto& [a, b, c] : unit_square().triangles) mesh.triangles.push_back({b + 4, c + 4, a + 4});
    CHECK(joined(mesh).triangles == unit_square().triangles);
  }

  TEST_CASE("a square is the same as its other two triangles, a grid as another") {
    Mesh mesh = unit_square();
    add_flat(mesh, {{{{0, 0}, {1, 0}, {0, 1}}}, {{{1, 0}, {1, 1}, {0, 1}}}});
    CHECK(joined(mesh).triangles == unit_square().triangles);
    for (const std::uint64_t plane : {0, 1, 2}) {
      Mesh grids;
      add_rectangle(grids, {0, 0}, {1, 1}, 12, 12);
      const Mesh first = grids;
      add_rectangle(grids, {0, 0}, {1, 1}, 5, 5);
      if (plane > 0) move(grids, into_plane(plane));
      const Mesh after = joined(grids);
      CHECK(after.triangles == first.triangles);
      CHECK(after.coincident == 50);
    }
  }

  TEST_CASE("rectangles that overlap in part: the first is whole, and the rest is the union") {
    for (const std::uint64_t plane : {0, 1, 2, 3})
      for (const bool turned : {false, true}) {
        CAPTURE(plane);
        Mesh mesh;
        mesh.normals.resize(8, {0, 0, 1});
        add_rectangle(mesh, {0, 0}, {2, 1});
        add_rectangle(mesh, {1.5, 0.25}, {3, 2});
        if (turned) turn_from(mesh, 2);
        if (plane > 0) move(mesh, into_plane(plane));
        const Mesh after = joined(mesh);
        CHECK(area_of(after) == doctest::Approx(2 + 1.5 * 1.75 - 0.5 * 0.75).epsilon(1e-9));
        CHECK(std::equal(mesh.triangles.begin(), mesh.triangles.begin() + 2, after.triangles.begin()));
        CHECK(after.coincident >= 1);
        REQUIRE(after.normals.size() == after.positions.size());
        CHECK(after.normals.back() == glm::dvec3{0.0});
        for (const auto& corners : after.triangles) CHECK(doubled_area(after, corners) > 1e-3);  // no slivers
      }
  }

  TEST_CASE("pieces are in the groups of their face; of faces in the same place, the groups of the first hold") {
    Mesh mesh;
    add_rectangle(mesh, {0, 0}, {2, 1});
    add_rectangle(mesh, {1.5, 0.25}, {3, 2});
    add_rectangle(mesh, {0, 0}, {2, 1});
    mesh.groups = {.names = {"a", "b", "c"}, .sets = {{0}, {1}, {2}}, .of_triangle = {0, 0, 1, 1, 2, 2}};
    const Mesh after = joined(mesh);
    REQUIRE(after.groups.of_triangle.size() == after.triangles.size());
    std::array<double, 3> areas{};
    for (std::size_t i = 0; i < after.triangles.size(); ++i)
      areas[after.groups.of_triangle[i]] += 0.5 * doubled_area(after, after.triangles[i]);
    CHECK(areas[0] == 2);
    CHECK(areas[1] == doctest::Approx(1.5 * 1.75 - 0.5 * 0.75).epsilon(1e-9));
    CHECK(areas[2] == 0);
  }

  TEST_CASE("boxes that stand on a floor leave its area as it is, and three layers are one") {
    for (const bool floor_first : {true, false}) {
      Mesh mesh;
      const auto floor = [&] { built_in::add_quad(mesh, {{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}}, 4); };
      if (floor_first) floor();
      built_in::add_box(mesh, {1, 1, 0}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, 1);
      built_in::add_box(mesh, {2, 2, 0}, {{{0.5, 0, 0}, {0, 0.7, 0}, {0, 0, 1}}}, 1);
      if (!floor_first) floor();
      CHECK(area_of(joined(mesh)) == doctest::Approx(16 + 5 + 0.35 + 2.4).epsilon(1e-12));
    }
    Mesh layers;
    add_rectangle(layers, {0, 0}, {1, 1}, 3, 3);
    add_rectangle(layers, {-1, 0}, {2, 0.5}, 2, 1);
    turn_from(layers, 18);
    add_rectangle(layers, {0.25, -1}, {0.75, 2}, 1, 7);
    CHECK(area_of(joined(layers)) == doctest::Approx(1 + 1 + 1).epsilon(1e-9));
  }

  TEST_CASE("a large square listed after its grid vanishes; if the grid has a hole, the hole remains") {
    Mesh mesh;
    add_rectangle(mesh, {0, 0}, {1, 1}, 40, 40);
    const std::size_t in_grid = mesh.triangles.size();
    add_rectangle(mesh, {0, 0}, {1, 1});
    CHECK(joined(mesh).triangles.size() == in_grid);
    mesh.triangles.erase(mesh.triangles.begin() + 100, mesh.triangles.begin() + 120);
    const Mesh after = joined(mesh);
    CHECK(area_of(after) == doctest::Approx(1).epsilon(1e-9));
    CHECK(after.coincident == 2);
  }

  TEST_CASE("scenes of any size, and far from the origin, give the same triangles") {
    Mesh mesh;
    add_rectangle(mesh, {0, 0}, {2, 1});
    add_rectangle(mesh, {1.5, 0.25}, {3, 2}, 2, 2);
    turn_from(mesh, 2);
    move(mesh, into_plane(7));
    const Mesh expected = joined(mesh);
    for (const double scale : {1e-200, 1e-150, 1e150, 1e200}) {
      CAPTURE(scale);
      Mesh scaled = mesh;
      move(scaled, [&](const glm::dvec3& at) { return scale * at; });
      Mesh after = joined(scaled);
      CHECK(after.triangles.size() == expected.triangles.size());
      move(after, [&](const glm::dvec3& at) { return at / scale; });
      CHECK(area_of(after) == doctest::Approx(area_of(expected)).epsilon(1e-9));
    }
    Mesh far = mesh;
    move(far, [&](const glm::dvec3& at) { return at + glm::dvec3{1e6, -1e6, 1e5}; });
    CHECK(area_of(joined(far)) == doctest::Approx(area_of(expected)).epsilon(1e-8));
  }
}

TEST_SUITE("identity") {
  TEST_CASE("random overlapping triangles of a plane cover what their union covers, in any order") {
    for (std::uint64_t number = 0; number < 12; ++number) {
      CAPTURE(number);
      Mesh mesh = random_triangles(number, 4 + 3 * static_cast<std::uint32_t>(number));
      const double expected = area_of_union(mesh);
      if (number % 3 != 0) move(mesh, into_plane(number));
      CHECK(area_of(joined(mesh)) == doctest::Approx(expected).epsilon(1e-6));
      for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        std::swap(mesh.triangles[i], mesh.triangles[bits4(33, Stream::tests, number, i)[0] % mesh.triangles.size()]);
      CHECK(area_of(joined(mesh)) == doctest::Approx(expected).epsilon(1e-6));
      CHECK(is_untouched(joined(joined(mesh))));
    }
  }

  TEST_CASE("meshes without overlap stay as they are: closed ones, grids, T-junctions, slivers, and none at all") {
    Mesh ball;
    built_in::add_ball(ball, {1, 2, 3}, 0.7, 12);
    CHECK(is_untouched(ball));
    for (std::uint64_t plane = 0; plane < 8; ++plane) {
      Mesh grid;
      add_rectangle(grid, {0, 0}, {1, 0.3}, 9, 7);
      add_rectangle(grid, {0, 0.3}, {1, 1}, 4, 5);  // T-junctions
      add_rectangle(grid, {1, 0}, {1 + 1e-7, 1}, 1, 6);
      add_rectangle(grid, {2, 0}, {3, 1e-12});  // slivers without a height
      add_rectangle(grid, {2, 0}, {3, 1e-12}, 2);
      add_flat(grid, {{{{0, 0}, {1, 1}, {2, 2}}}, {{{0, 0}, {0, 0}, {0, 0}}}, {{{0, 0}, {1, 1}, {2, 2}}}});
      add_flat(grid, {{{{0, 0}, {1, 0}, {1, 1}}}}, 1e-7);
      if (plane > 0) move(grid, into_plane(plane));
      CHECK(is_untouched(grid));
    }
    CHECK(is_untouched(Mesh{}));
    Mesh point = unit_square();
    move(point, [](const glm::dvec3&) { return glm::dvec3{1.0}; });
    CHECK(is_untouched(point));
  }

  TEST_CASE("random closed meshes stay as they are, folded as they may be") {
    for (std::uint64_t number = 0; number < 20; ++number) {
      Mesh ball;
      built_in::add_ball(ball, {0, 0, 0}, 1, 6);
      std::uint64_t vertex = 0;
      move(ball, [&](const glm::dvec3& at) {
        const auto random = uniform4(34, Stream::tests, number, ++vertex);
        return at * (0.3 + random[0]);
      });
      CHECK(is_untouched(ball));
    }
  }

  TEST_CASE("a request stops the search") {
    Mesh mesh;
    add_rectangle(mesh, {0, 0}, {1, 1}, 200, 200);
    std::stop_source source;
    source.request_stop();
    Notices notices;
    CHECK_THROWS_AS(join_coincident(mesh, notices, source.get_token()), Stopped);
  }
}
