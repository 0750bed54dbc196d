#include "detp/sim/effects/sample_groups.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <vector>

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
}
