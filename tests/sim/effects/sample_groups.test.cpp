#include "detp/sim/effects/sample_groups.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <vector>

#include "detp/sim/effects/sample_dimension.hpp"
#include "detp/sim/effects/sampled_tree.hpp"
#include "detp/sim/geometry/curve.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/search/problem.hpp"

using namespace detp::sim;

namespace {

double distance(const Ray& ray, const glm::dvec3& point) {
  const double along = glm::dot(point - ray.origin, ray.direction);
  const double nearest = std::clamp(along, ray.is_line() ? -unbounded : 0.0, ray.length);
  return glm::length(point - ray.origin - nearest * ray.direction);
}

struct Setup {
  std::vector<Disc> discs;
  CurveSample sample;
  std::vector<SampledNode> tree;

  explicit Setup(std::vector<Disc> all)
      : discs(std::move(all)), sample(curve_sample(discs, enclosing_sphere(discs))), tree(sampled_tree(sample)) {}
};

/// Lines, segments inside, and segments that end far outside.
std::vector<Ray> some_rays(const Sphere& sphere) {
  auto rays = LineField(sphere, 1).lines(0, 300);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (i % 3 == 1) rays[i].length = 0.5 * sphere.radius;
    if (i % 3 == 2) {
      rays[i].origin -= 1e9 * sphere.radius * rays[i].direction;
      rays[i].length = 2e9 * sphere.radius;
    }
  }
  return rays;
}

SampleDimension dimension_of(std::span<const Disc> discs, std::uint64_t seed = 1) {
  return sample_dimension(
      curve_sample(discs, stratified_sample(discs.size(), 8192, seed, Stream::evidence), {.radius = 2}).keys);
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("the discs near a ray are those whose centres are near, wherever the scene lies") {
    for (const double shift : {0.0, 1e6}) {
      auto discs = uniform_discs(Body::cube_faces, 2, 5000, 0.01, 1);
      for (Disc& disc : discs) disc.centre += shift;
      const Setup setup(std::move(discs));
      const Sphere sphere = enclosing_sphere(setup.discs);
      const double near = 0.05;
      const SampleGroups groups(setup.sample, setup.tree, 1, 0.2, near);
      std::size_t wrong = 0;
      for (const Ray& ray : some_rays(sphere)) {
        std::vector<bool> found(setup.discs.size());
        const std::uint32_t around = groups.visit_near(ray, [&](std::uint32_t place) {
          wrong += found[setup.sample.discs[place].number] ? 1 : 0;  // visited twice
          found[setup.sample.discs[place].number] = true;
        });
        double exact = 0;
        for (std::size_t i = 0; i < setup.discs.size(); ++i) {
          const double apart = distance(ray, setup.discs[i].centre);
          if (std::abs(apart - near) > 1e-3 * near) wrong += found[i] == (apart < near) ? 0 : 1;
          exact += apart < 0.2 ? 1 : 0;
        }
        CHECK(std::abs(around - exact) <= 20 + 0.25 * exact);  // groups count as a whole
      }
      CHECK(wrong == 0);
    }
  }

  TEST_CASE("groups that are large against the reach are counted disc by disc") {
    const Setup setup(uniform_discs(Body::cube, 2, 3000, 0.01, 1));
    const SampleGroups groups(setup.sample, setup.tree, 1, 0.1, 0.1);
    for (const Ray& ray : some_rays(enclosing_sphere(setup.discs))) {
      std::uint32_t visited = 0;
      const std::uint32_t around = groups.visit_near(ray, [&](std::uint32_t) { ++visited; });
      CHECK(around == visited);
    }
  }

  TEST_CASE("the mean count around rays is not biased by counting groups as a whole") {
    const Setup setup(uniform_discs(Body::cube_faces, 2, 8000, 0.01, 1));
    const SampleGroups groups(setup.sample, setup.tree, 1, 0.3, 0.01);
    double found = 0;
    double exact = 0;
    for (const Ray& ray : some_rays(enclosing_sphere(setup.discs))) {
      found += groups.visit_near(ray, [](std::uint32_t) {});
      for (const Disc& disc : setup.discs) exact += distance(ray, disc.centre) < 0.3 ? 1 : 0;
    }
    CHECK(found == doctest::Approx(exact).epsilon(0.02));
  }

  TEST_CASE("with a step, every so many of the discs are found") {
    const Setup setup(uniform_discs(Body::cube_faces, 2, 4001, 0.01, 1));
    constexpr std::uint32_t step = 7;
    const SampleGroups all(setup.sample, setup.tree, 1, 0.2, 0.2);
    const SampleGroups some(setup.sample, setup.tree, step, 0.2, 0.2);
    for (const Ray& ray : some_rays(enclosing_sphere(setup.discs))) {
      std::vector<std::uint32_t> expected;
      std::vector<std::uint32_t> found;
      all.visit_near(ray, [&](std::uint32_t place) {
        if (place % step == 0) expected.push_back(place);
      });
      some.visit_near(ray, [&](std::uint32_t place) { found.push_back(place); });
      std::sort(expected.begin(), expected.end());
      std::sort(found.begin(), found.end());
      CHECK(found == expected);
    }
  }

  TEST_CASE("the dimension of uniform samples is that of their body, to 0.1") {
    CHECK(std::abs(dimension_of(uniform_discs(Body::cube, 2, 100'000, 0.01, 1)).value - 3) < 0.1);
    CHECK(std::abs(dimension_of(uniform_discs(Body::cube_faces, 2, 100'000, 0.01, 1)).value - 2) < 0.1);
  }

  TEST_CASE("points on a line have dimension 1; a few points count as a volume") {
    auto discs = uniform_discs(Body::cube, 2, 50'000, 0.01, 1);
    for (Disc& disc : discs) disc.centre.y = disc.centre.z = 0;
    CHECK(std::abs(dimension_of(discs).value - 1) < 0.1);
    CHECK(dimension_of(std::span(discs).first(100)).value == 3);
  }

  TEST_CASE("sampled discs follow the curve of lebesgue_code, but for rounding at the borders of cells") {
    const auto discs = uniform_discs(Body::cube, 2, 8000, 0.01, 1);
    const CurveSample sample = curve_sample(discs, enclosing_sphere(discs));
    REQUIRE(sample.discs.size() == discs.size());
    Box box;
    for (const Disc& disc : discs) box.include(disc.centre);
    std::set<std::uint32_t> numbers;
    std::size_t other_cells = 0;
    double farthest = 0;
    double steepest = 0;
    for (std::size_t i = 0; i < sample.discs.size(); ++i) {
      const Disc& disc = discs[sample.discs[i].number];
      numbers.insert(sample.discs[i].number);
      other_cells += sample.keys[i] == lebesgue_code(disc.centre, box) ? 0 : 1;
      const glm::dvec3 centre = glm::dvec3(sample.discs[i].centre) * sample.unit + sample.origin;
      farthest = std::max(farthest, glm::length(centre - disc.centre));
      steepest = std::max(steepest, std::abs(sample.discs[i].steepness.x - std::abs(disc.normal.x)));
    }
    CHECK(farthest < 1e-6);
    CHECK(steepest < 1e-6);
    CHECK(numbers.size() == discs.size());
    CHECK(other_cells < discs.size() / 20);
    CHECK(std::is_sorted(sample.keys.begin(), sample.keys.end()));
  }

  TEST_CASE("a node is split where the curve leaves a cell, and its box holds its discs") {
    const auto discs = uniform_discs(Body::cube_faces, 2, 5000, 0.01, 1);
    const CurveSample sample = curve_sample(discs, enclosing_sphere(discs));
    const auto nodes = sampled_tree(sample);
    REQUIRE(nodes.front().size() == sample.discs.size());
    CHECK(nodes.front().next == nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const SampledNode& node = nodes[i];
      bool holds = true;
      for (std::uint32_t j = node.first; j < node.end; ++j) {
        const SampledDisc& disc = sample.discs[j];
        for (int axis = 0; axis < 3; ++axis)
          holds = holds && node.low[axis] <= disc.centre[axis] && node.high[axis] >= disc.centre[axis] &&
                  node.flattest[axis] <= disc.steepness[axis];
      }
      CHECK(holds);
      if (node.size() < least_split) {
        CHECK(node.next == i + 1);
        continue;
      }
      const SampledNode& a = nodes[i + 1];
      const SampledNode& b = nodes[a.next];
      CHECK(a.first == node.first);
      CHECK(a.end == b.first);
      CHECK(b.end == node.end);
      CHECK(b.next == node.next);
      // the first bit in which the keys of the node differ is 0 in the one part and 1 in the other
      const std::uint64_t differ = sample.keys[node.first] ^ sample.keys[node.end - 1];
      if (differ == 0) continue;
      const std::uint64_t bit = std::bit_floor(differ);
      CHECK((sample.keys[a.end - 1] & bit) == 0);
      CHECK((sample.keys[b.first] & bit) != 0);
    }
  }
}

TEST_SUITE("statistical") {
  TEST_CASE("the standard error of the dimension is that of repeated samples, within a factor of two") {
    // on the faces of a cube, because a volume's dimension is often clamped at 3
    const auto discs = uniform_discs(Body::cube_faces, 2, 200'000, 0.01, 1);
    constexpr int samples = 60;
    double mean = 0;
    double squares = 0;
    double stated = 0;
    for (int seed = 1; seed <= samples; ++seed) {
      const SampleDimension found = dimension_of(discs, static_cast<std::uint64_t>(seed));
      mean += found.value / samples;
      squares += found.value * found.value / samples;
      stated += found.standard_error / samples;
    }
    const double spread = std::sqrt(std::max(0.0, squares - mean * mean));
    INFO("spread ", spread, ", stated ", stated);
    CHECK(stated > 0.5 * spread);
    CHECK(stated < 2 * spread);
  }
}
