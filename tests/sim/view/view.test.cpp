#include "detp/sim/view/view.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "detp/sim/view/nearest_disc.hpp"

using namespace detp::sim;

namespace {

/// A unit square at z = height, facing +z.
void add_square(Mesh& mesh, double height, double side = 1) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}})
    mesh.positions.emplace_back(side * x, side * y, height);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// A box without its face at z = 1, seen from inside: sights on the other five.
Mesh open_box() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2 & 1);
  for (const std::array<std::uint32_t, 4>& face :
       {std::array<std::uint32_t, 4>{0, 1, 3, 2}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}) {
    mesh.triangles.push_back({face[0], face[1], face[2]});
    mesh.triangles.push_back({face[0], face[2], face[3]});
  }
  return mesh;
}

/// Sights all over the inner side of each triangle.
std::vector<Sight> inner_sights(const Mesh& mesh) {
  constexpr int steps = 6;
  std::vector<Sight> sights;
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec3 first = mesh.positions[b] - mesh.positions[a];
    const glm::dvec3 second = mesh.positions[c] - mesh.positions[a];
    glm::dvec3 normal = glm::normalize(glm::cross(first, second));
    if (glm::dot(normal, glm::dvec3(0.5) - mesh.positions[a]) < 0) normal = -normal;
    for (int i = 0; i < steps; ++i)
      for (int j = 0; i + j < steps; ++j)
        sights.push_back({mesh.positions[a] + (i + 0.3) / steps * first + (j + 0.3) / steps * second, normal});
  }
  return sights;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a cell knows its triangle, the place in it and the depth") {
    Mesh mesh;
    add_square(mesh, 0);
    const RayCaster caster(mesh, used_box(mesh));
    const View view = view_between({0.5, 0.5, 2}, {0.5, 0.5, 0}, Up{});
    const Cells cells(view, 1200);
    CHECK(cells.width == 40);
    CHECK(cells.height == 30);
    const std::vector<Seen> seen = look(caster, mesh, view, cells, 1);
    int met = 0;
    for (int y = 0; y < cells.height; ++y)
      for (int x = 0; x < cells.width; ++x) {
        const Seen& one = seen[cells.index(x, y)];
        // At the distance 2 the picture is 1.6 high.
        const glm::dvec3 place{0.5 + (x + 0.5 - 20) * 1.6 / 30, 0.5 - (y + 0.5 - 15) * 1.6 / 30, 0};
        const bool inside = place.x > 0 && place.x < 1 && place.y > 0 && place.y < 1;
        REQUIRE(one.anything() == inside);
        if (!inside) continue;
        ++met;
        const auto& [a, b, c] = mesh.triangles[one.triangle];
        const glm::dvec3 found = (1 - one.second - one.third) * mesh.positions[a] + one.second * mesh.positions[b] +
                                 one.third * mesh.positions[c];
        CHECK(glm::distance(found, place) < 1e-9);
        CHECK(one.depth == doctest::Approx(2));
      }
    CHECK(met > 300);
    CHECK(seen.size() == look(caster, mesh, view, cells, 4).size());
  }

  TEST_CASE("the view into an open box is through its open side") {
    const Mesh mesh = open_box();
    const RayCaster caster(mesh, used_box(mesh));
    const View view = view_of_most(caster, mesh, Up{}, inner_sights(mesh));
    CHECK(view.from.z > 1);
    CHECK(std::abs(view.from.x - 0.5) < view.from.z - 0.5);
    const Cells cells(view, 3000);
    const std::vector<Seen> seen = look(caster, mesh, view, cells, 1);
    // All of it is within the picture, which has an empty margin.
    for (int x = 0; x < cells.width; ++x) {
      CHECK_FALSE(seen[cells.index(x, 0)].anything());
      CHECK_FALSE(seen[cells.index(x, cells.height - 1)].anything());
    }
  }

  TEST_CASE("the view of a closed box is from within") {
    Mesh mesh = open_box();
    mesh.triangles.push_back({4, 5, 7});
    mesh.triangles.push_back({4, 7, 6});
    const RayCaster caster(mesh, used_box(mesh));
    const View view = view_of_most(caster, mesh, Up{}, inner_sights(mesh));
    for (int axis = 0; axis < 3; ++axis) CHECK((view.from[axis] > 0 && view.from[axis] < 1));
  }

  TEST_CASE("a flat mesh is seen as a plan, from the side that its sights face") {
    Mesh mesh;
    add_square(mesh, 0);
    mesh.positions[1].x = mesh.positions[2].x = 3;
    const RayCaster caster(mesh, used_box(mesh));
    for (const double side : {-1.0, 1.0}) {
      const std::vector<Sight> sights{{{1, 0.5, 0}, {0, 0, side}}};
      const View view = view_of_most(caster, mesh, Up{}, sights);
      CHECK(view.plan);
      CHECK(view.from.z * side > 0);
      CHECK(view.aspect == 2.5);
      CHECK(2 * view.half_height * view.aspect == doctest::Approx(1.05 * 3));
    }
  }

  TEST_CASE(
      "outlines are where a surface ends, is bent, or another one is before it; not where it is seen at a grazing "
      "angle") {
    Mesh mesh;
    add_square(mesh, 0);
    add_square(mesh, 0.5, 0.5);
    const RayCaster caster(mesh, used_box(mesh));
    View view = view_between({0.5, 0.5, 100}, {0.5, 0.5, 0}, Up{});
    view.half_height = 0.006;
    const Cells cells(view, 4800);
    const std::vector<Seen> seen = look(caster, mesh, view, cells, 1);
    const std::vector<char> marked = outlines(seen, mesh, view, cells);
    for (int y = 1; y + 1 < cells.height; ++y)
      for (int x = 1; x + 1 < cells.width; ++x) {
        const auto level = [&](int i, int j) {
          const Seen& one = seen[cells.index(i, j)];
          return !one.anything() ? 0 : one.triangle < 2 ? 1 : 2;
        };
        const int highest = std::max({level(x - 1, y), level(x + 1, y), level(x, y - 1), level(x, y + 1)});
        REQUIRE((marked[cells.index(x, y)] == 1) == (highest > level(x, y)));
      }
    const View grazing = view_between({0.5, -3, 0.3}, {0.5, 0.5, 0}, Up{2, 1});
    Mesh floor;
    add_square(floor, 0);
    const RayCaster of_floor(floor, used_box(floor));
    const Cells low(grazing, 4800);
    const std::vector<Seen> of_low = look(of_floor, floor, grazing, low, 1);
    const std::vector<char> edges = outlines(of_low, floor, grazing, low);
    for (std::size_t i = 0; i < edges.size(); ++i)
      if (of_low[i].anything()) REQUIRE(edges[i] == 0);
  }

  TEST_CASE("a place gets the nearest disc that faces as its surface does and is within reach") {
    const std::vector<Disc> discs{
        {{0, 0, 0}, {0, 0, 1}, 0.1}, {{0.1, 0, 0}, {1, 0, 0}, 0.1}, {{1, 0, 0}, {0, 0, -1}, 0.5}};
    const NearestDisc nearest(discs);
    CHECK(nearest.at({0.09, 0, 0}, {0, 0, 1}) == 0);
    CHECK(nearest.at({0.09, 0, 0}, {-1, 0, 0}) == 1);
    CHECK(nearest.at({0.4, 0, 0}, {0, 0, 1}) == 2);  // 0 is nearer, but out of reach
    CHECK_FALSE(nearest.at({0.4, 3, 0}, {0, 0, 1}));
    CHECK_FALSE(nearest.at({0.09, 0, 0}, {0, 1, 0}));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a view leads from one place to another") {
    CHECK_THROWS_AS(static_cast<void>(view_between({1, 2, 3}, {1, 2, 3}, Up{})), std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(view_between({1, 2, NAN}, {1, 2, 3}, Up{})), std::invalid_argument);
    const View down = view_between({0, 5, 0}, {0, 0, 0}, Up{});
    CHECK(glm::length(glm::cross(down.up, {0, 1, 0})) > 0.5);
  }
}
