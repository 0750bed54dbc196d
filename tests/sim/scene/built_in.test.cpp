#include "detp/sim/scene/built_in/built_in.hpp"
#include "detp/sim/scene/vertices.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace detp::sim;

namespace {

double scene_size(const Mesh& mesh) {
  Box box;
  for (const glm::dvec3& position : mesh.positions) box.include(position);
  const glm::dvec3 size = box.size();
  return std::max(std::max(size.x, size.y), size.z);
}

/// The mesh's triangles first … last - 1.
Mesh part(const Mesh& mesh, std::size_t first, std::size_t last) {
  Mesh some{.positions = mesh.positions, .normals = {}, .triangles = {}};
  for (std::size_t i = first; i < last; ++i) some.triangles.push_back(mesh.triangles[i]);
  return some;
}

/// Mean edge lengths, divided by the scene's size. The ground of a tree scene comes first in its mesh.
struct Edges {
  double ground;
  double plant;
};

Edges edges_of(const Mesh& mesh, std::size_t cells) {
  const std::size_t ground = 2 * cells * cells;
  const double size = scene_size(mesh);
  return {mean_edge_length(part(mesh, 0, ground)) / size,
          mean_edge_length(part(mesh, ground, mesh.triangles.size())) / size};
}

struct Named {
  const char* name;
  built_in::LitMesh (*make)();
};

constexpr Named all[]{{"tree", built_in::tree},           {"tree_coarse", built_in::tree_coarse},
                      {"courtyard", built_in::courtyard}, {"cornell", built_in::cornell},
                      {"caustic", built_in::caustic},     {"interior", built_in::interior}};

/// Twice the area, divided by the square of the longest edge.
double relative_area(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const glm::dvec3 u = mesh.positions[triangle[1]] - mesh.positions[triangle[0]];
  const glm::dvec3 v = mesh.positions[triangle[2]] - mesh.positions[triangle[0]];
  const double longest = std::max(std::max(glm::dot(u, u), glm::dot(v, v)), glm::dot(v - u, v - u));
  return glm::length(glm::cross(u, v)) / longest;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("the tree has the paper's 72 500 triangles, its ground edges of 2 % and its tree edges of 1 %") {
    const Mesh mesh = built_in::tree().mesh;
    CHECK(static_cast<double>(mesh.triangles.size()) == doctest::Approx(72'500).epsilon(0.01));
    const Edges edges = edges_of(mesh, 57);
    CHECK(edges.ground == doctest::Approx(0.02).epsilon(0.1));
    CHECK(edges.plant == doctest::Approx(0.01).epsilon(0.1));
  }

  TEST_CASE("the coarse tree has 18 000 triangles, with edges twice as long") {
    const Mesh mesh = built_in::tree_coarse().mesh;
    CHECK(static_cast<double>(mesh.triangles.size()) == doctest::Approx(18'000).epsilon(0.03));
    const Edges edges = edges_of(mesh, 28);
    CHECK(edges.ground == doctest::Approx(0.04).epsilon(0.1));
    CHECK(edges.plant == doctest::Approx(0.02).epsilon(0.1));
  }

  TEST_CASE("the courtyard has 120 000 triangles and the paper's mean edge of 0.0133") {
    const Mesh mesh = built_in::courtyard().mesh;
    CHECK(static_cast<double>(mesh.triangles.size()) == doctest::Approx(120'000).epsilon(0.03));
    CHECK(mean_edge_length(mesh) / scene_size(mesh) == doctest::Approx(0.0133).epsilon(0.05));
  }

  TEST_CASE("the Cornell box has about 10 000 triangles, all within the unit cube, and its light under the ceiling") {
    const built_in::LitMesh lit_mesh = built_in::cornell();
    CHECK(static_cast<double>(lit_mesh.mesh.triangles.size()) == doctest::Approx(10'000).epsilon(0.05));
    for (const glm::dvec3& position : lit_mesh.mesh.positions)
      for (int axis = 0; axis < 3; ++axis) CHECK((position[axis] >= 0 && position[axis] <= 1));
    const auto light = std::get<AreaLight>(lit_mesh.lights.at(0).shape);
    CHECK(light.corner.y < 1);
    CHECK(light.corner.y > 0.99);
  }

  TEST_CASE("materials are sound, and every triangle of @caustic and @interior has one") {
    for (const auto& [bound_name, make] : all) {
      const auto& name = bound_name;
      CAPTURE(name);
      const Mesh mesh = make().mesh;
      CHECK_NOTHROW(check(mesh.materials, mesh.triangles.size()));
      CHECK(mesh.materials.of_triangle.size() == (mesh.materials.all.empty() ? 0 : mesh.triangles.size()));
    }
  }

  TEST_CASE("the glass ball of @caustic looks outwards, and so does the room of @interior inwards") {
    const Mesh ball = built_in::caustic().mesh;
    Mesh room = built_in::interior().mesh;
    const glm::dvec3 centre{1.3, 0.9, 1.6};
    std::size_t outwards = 0;
    std::size_t glass = 0;
    for (std::size_t i = 0; i < ball.triangles.size(); ++i) {
      if (ball.materials.of(i).glass == 0) continue;
      const auto& [a, b, c] = ball.triangles[i];
      const glm::dvec3 normal =
          glm::cross(ball.positions[b] - ball.positions[a], ball.positions[c] - ball.positions[a]);
      ++glass;
      if (glm::dot(normal, ball.positions[a] - centre) > 0) ++outwards;
    }
    CHECK(glass > 5000);
    CHECK(outwards == glass);
    Notices notices;
    for (const Sample& sample : samples_at_vertices(room, default_crease, notices)) {
      const glm::dvec3& p = sample.position;
      if (p.y == 2.8 && p.x > 0.01 && p.x < 5.99 && p.z > 0.01 && p.z < 4.99)
        CHECK(sample.normal.y == doctest::Approx(-1));
      if (p.x == 0 && p.y > 0.01 && p.y < 2.79 && p.z > 0.01 && p.z < 4.99)
        CHECK(sample.normal.x == doctest::Approx(1));
    }
  }

  TEST_CASE("the lights shine down") {
    for (const auto& [bound_name, make] : all) {
      const auto& name = bound_name;
      CAPTURE(name);
      bool shines_down = false;
      for (const Light& light : make().lights)
        if (const auto* area = std::get_if<AreaLight>(&light.shape))
          shines_down = shines_down || glm::cross(area->edge_u, area->edge_v).y < 0;
      CHECK(shines_down);
    }
  }

  TEST_CASE("the flat surfaces of the Cornell box face the room") {
    Mesh mesh = built_in::cornell().mesh;
    Notices notices;
    for (const Sample& sample : samples_at_vertices(mesh, default_crease, notices)) {
      const glm::dvec3& p = sample.position;
      if (p.y == 1 && p.x > 0 && p.x < 1 && p.z > 0) CHECK(sample.normal.y == doctest::Approx(-1));
      if (p.y == 0 && p.x > 0 && p.x < 1 && p.z > 0.05 && p.z < 0.1) CHECK(sample.normal.y == doctest::Approx(1));
      if (p.x == 0 && p.y > 0 && p.y < 1 && p.z > 0) CHECK(sample.normal.x == doctest::Approx(1));
      if (p.x == 1 && p.y > 0 && p.y < 1 && p.z > 0) CHECK(sample.normal.x == doctest::Approx(-1));
    }
  }

  TEST_CASE("the ground of the trees faces up") {
    for (const auto& [make, cells] : {std::pair{&built_in::tree, 57U}, std::pair{&built_in::tree_coarse, 28U}}) {
      Mesh ground = part(make().mesh, 0, 2 * cells * cells);
      Notices notices;
      for (const Sample& sample : samples_at_vertices(ground, default_crease, notices)) CHECK(sample.normal.y > 0.3);
    }
  }
}

TEST_SUITE("identity") {
  TEST_CASE("every built-in mesh is the same on every call") {
    for (const auto& [bound_name, make] : all) {
      const auto& name = bound_name;
      CAPTURE(name);
      const Mesh first = make().mesh;
      const Mesh second = make().mesh;
      CHECK(first.positions == second.positions);
      CHECK(first.triangles == second.triangles);
    }
  }

  TEST_CASE("no triangle of a built-in mesh is degenerate, and every vertex is a sample with a unit normal") {
    for (const auto& [bound_name, make] : all) {
      const auto& name = bound_name;
      CAPTURE(name);
      Mesh mesh = make().mesh;
      double thinnest = 1;
      for (const auto& triangle : mesh.triangles) thinnest = std::min(thinnest, relative_area(mesh, triangle));
      CHECK(thinnest > 0.01);
      Notices notices;
      const std::vector<Sample> samples = samples_at_vertices(mesh, default_crease, notices);
      CHECK(samples.size() == mesh.positions.size());
      CHECK(notices.empty());
      double worst = 0;
      for (const Sample& sample : samples) worst = std::max(worst, std::abs(glm::length(sample.normal) - 1));
      CHECK(worst < 1e-14);
    }
  }

  TEST_CASE("a uniform sample depends on the seed and its own number, not on how many there are") {
    const auto few = built_in::uniform_samples(10, 5);
    const auto many = built_in::uniform_samples(1000, 5);
    const auto other = built_in::uniform_samples(10, 6);
    for (std::size_t i = 0; i < few.size(); ++i) {
      CHECK(few[i].position == many[i].position);
      CHECK(few[i].normal == many[i].normal);
      CHECK(few[i].position != other[i].position);
    }
  }
}

TEST_SUITE("statistical") {
  TEST_CASE("uniform samples fill the cube evenly, and their normals the sphere") {
    constexpr std::size_t count = 100'000;
    glm::dvec3 place{0.0}, normal{0.0}, squares{0.0};
    for (const Sample& sample : built_in::uniform_samples(count, 3)) {
      place += sample.position;
      normal += sample.normal;
      squares += sample.normal * sample.normal;
    }
    // All variances are below 1/3; the bound is five standard errors.
    const double bound = 5 * std::sqrt(1.0 / 3 / count);
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(std::abs(place[axis] / count) < bound);
      CHECK(std::abs(normal[axis] / count) < bound);
      CHECK(std::abs(squares[axis] / count - 1.0 / 3) < bound);
    }
  }
}
