#include "detp/sim/files/polygon.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <random>

using namespace detp::sim;

namespace {

using Outline = std::vector<glm::dvec2>;

struct Divided {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  PolygonCounts counts;
};

Divided divided(const std::vector<glm::dvec3>& corners) {
  Triangulator triangulator;
  StopCheck check;
  Divided result;
  triangulator.divide(corners, check, result.triangles);
  result.counts = triangulator.counts();
  return result;
}

/// In a plane of any orientation, some way from the origin.
std::vector<glm::dvec3> placed(const Outline& outline, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> number;
  const auto vector = [&] { return glm::dvec3{number(random), number(random), number(random)}; };
  const glm::dvec3 u = glm::normalize(vector());
  const glm::dvec3 v = glm::normalize(glm::cross(u, vector()));
  const glm::dvec3 from = vector();
  std::vector<glm::dvec3> corners;
  for (const glm::dvec2& one : outline) corners.push_back(from + one.x * u + one.y * v);
  return corners;
}

double shoelace(const Outline& p) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const glm::dvec2& next = p[(i + 1) % p.size()];
    sum += p[i].x * next.y - next.x * p[i].y;
  }
  return 0.5 * sum;
}

double area(const Outline& p, const std::array<std::uint32_t, 3>& t) { return shoelace({p[t[0]], p[t[1]], p[t[2]]}); }

bool inside(const Outline& p, const glm::dvec2& at) {
  bool odd = false;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const glm::dvec2& a = p[i];
    const glm::dvec2& b = p[(i + 1) % p.size()];
    if ((a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x)) odd = !odd;
  }
  return odd;
}

/// Triangles of the polygon's orientation that cover each point inside once and none outside, with all corners.
void check_divided(const Outline& outline, std::uint64_t seed = 1) {
  const double exact = shoelace(outline);
  const Divided found = divided(placed(outline, seed));
  REQUIRE(found.triangles.size() == outline.size() - 2);
  double sum = 0;
  std::map<std::uint32_t, double> of_corner;
  for (const auto& triangle : found.triangles) {
    const double one = area(outline, triangle);
    CHECK(one * exact >= -1e-9 * exact * exact);
    sum += one;
    for (const std::uint32_t corner : triangle) of_corner[corner] = std::max(of_corner[corner], std::abs(one));
  }
  CHECK(sum == doctest::Approx(exact).epsilon(1e-10));
  for (std::uint32_t corner = 0; corner < outline.size(); ++corner) CHECK(of_corner[corner] > 0);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(-3, 5);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec2 at{place(random), place(random)};
    int covered = 0;
    for (const auto& [a, b, c] : found.triangles) covered += inside({outline[a], outline[b], outline[c]}, at) ? 1 : 0;
    CHECK(covered == (inside(outline, at) ? 1 : 0));
  }
  CHECK(found.counts.degenerate == 0);
  CHECK(found.counts.not_plane == 0);
}

Outline turned(Outline outline, std::size_t first) {
  std::rotate(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(first), outline.end());
  return outline;
}

/// Corners at rising angles around the origin, at random distances.
Outline random_star(std::size_t corners, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> distance(0.2, 2.5);
  Outline star;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
    star.push_back(distance(random) * glm::dvec2{std::cos(angle), std::sin(angle)});
  }
  return star;
}

/// A corridor that winds inwards, `width` wide.
Outline spiral(int turns, double width) {
  Outline out;
  Outline back;
  for (int i = 0; i <= 12 * turns; ++i) {
    const double angle = std::numbers::pi * i / 6;
    const double radius = 2.4 - 0.1 * i / turns;
    out.push_back(radius * glm::dvec2{std::cos(angle), std::sin(angle)});
    back.push_back((radius - width / turns) * glm::dvec2{std::cos(angle), std::sin(angle)});
  }
  out.insert(out.end(), back.rbegin(), back.rend());
  return out;
}

const Outline bent{{2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 0}};

}  // namespace

TEST_SUITE("polygons") {
  TEST_CASE("triangles of a simple polygon do not overlap and have its area and corners, from any first corner") {
    const std::vector<Outline> outlines{
        {{0, 0}, {2, 0}, {2, 1}, {0, 1}},
        bent,
        {{0, 0}, {2, 1}, {0, 2}, {1, 1}},
        {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}},
        {{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}},
        {{0, 0}, {0.5, 0}, {1, 0}, {1.5, 0}, {2, 0}, {1, 2}},
        {{0, 0}, {4, 0}, {4, 3}, {0, 3}, {0, 0}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {1, 1}},  // a hole by a slit
        random_star(5, 1),
        random_star(40, 2),
        random_star(201, 3),
        spiral(2, 0.6),
        spiral(4, 0.7)};
    for (const Outline& outline : outlines)
      for (std::size_t first = 0; first < outline.size(); first += 1 + outline.size() / 12) {
        INFO("outline.size() ", outline.size(), ", first ", first);
        check_divided(turned(outline, first), first + 1);
        Outline clockwise = turned(outline, first);
        std::ranges::reverse(clockwise);
        check_divided(clockwise, first + 2);
      }
  }

  TEST_CASE("a convex polygon is the fan of its first corner, unless that makes a triangle without area") {
    const Outline square{{0, 0}, {2, 0}, {2, 1}, {0, 1}};
    CHECK(divided(placed(square, 1)).triangles == std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}});
    CHECK(divided(placed(turned(bent, 2), 1)).triangles ==
          std::vector<std::array<std::uint32_t, 3>>{
              {0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}});  // from the reflex corner
    CHECK(divided(placed(bent, 1)).counts.split == 0);
    CHECK(divided(placed(spiral(2, 0.6), 1)).counts.split == 1);
  }

  TEST_CASE("polygons without area, that cross themselves or bend are divided and counted") {
    const auto flat = [](const Outline& outline) {
      std::vector<glm::dvec3> corners;
      for (const glm::dvec2& one : outline) corners.emplace_back(one, 0);
      return corners;
    };
    for (const Outline& outline : {Outline{{0, 0}, {1, 0}, {2, 0}}, Outline{{0, 0}, {1, 0}, {2, 0}, {1, 0}},
                                   Outline{{1, 1}, {1, 1}, {1, 1}, {1, 1}}, Outline{{0, 0}, {1, 1}, {1, 0}, {0, 1}}}) {
      const Divided found = divided(flat(outline));
      CHECK(found.triangles.size() == outline.size() - 2);
      CHECK(found.counts.degenerate == 1);
    }
    const Divided bend = divided({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.2}, {0, 1, 0}});
    CHECK(bend.counts.not_plane == 1);
    CHECK(bend.counts.degenerate == 0);
    const double nan = std::nan("");
    CHECK(divided({{0, 0, 0}, {1, nan, 0}, {1, 1, 0}, {0, 1, 0}}).triangles.size() == 2);
    CHECK(divided({{0, 0, 0}, {1e308, 0, 0}, {1e308, 1e308, 0}, {-1e308, 1e308, 0}}).triangles.size() == 2);
    for (const double scale : {1e-150, 1e150}) {
      std::vector<glm::dvec3> tiny = flat(bent);
      for (glm::dvec3& corner : tiny) corner *= scale;
      CHECK(divided(tiny).triangles == divided(flat(bent)).triangles);
    }
  }
}
