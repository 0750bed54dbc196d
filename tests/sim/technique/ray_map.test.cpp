#include <doctest/doctest.h>

#include <array>
#include <vector>

#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

const std::vector<Disc>& surface_discs() {
  static const std::vector<Disc> all = uniform_discs(Body::cube_faces, 2, 2000, 0.02, 3);
  return all;
}

Outcome search(std::size_t rays, int leaf, Engine engine) {
  const auto lines = LineField(enclosing_sphere(surface_discs()), 7).lines(0, rays);
  return run(make_problem(lines, surface_discs()), {Technique::ray_map, RayMapParameters{leaf}},
             {.pairs = true, .engine = engine});
}

constexpr std::array both_engines{Engine::simd, Engine::plain};

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("leaves of any size find the hits of brute force, each once") {
    const auto lines = LineField(enclosing_sphere(surface_discs()), 7).lines(0, 3000);
    const Outcome expected = run(make_problem(lines, surface_discs()), Candidate{}, {.pairs = true});
    REQUIRE(expected.total_hits > 100);
    for (const Engine engine : both_engines)
      for (const int leaf : {1, 16, 1000, 1 << 20}) {
        const Outcome found = search(3000, leaf, engine);
        CHECK(found.pairs == expected.pairs);
        CHECK(found.irradiance == expected.irradiance);
      }
  }
}

TEST_SUITE("limit") {
  TEST_CASE("with one leaf for all rays it is brute force") {
    for (const Engine engine : both_engines) {
      const Outcome all = search(500, 500, engine);
      CHECK(all.counts.disc_tests == 500 * surface_discs().size());
      CHECK(all.counts.nodes == surface_discs().size());
      CHECK(all.counts.culls == 0);
    }
  }

  TEST_CASE("the ray map tests a small part of the rays; ten times the rays need less than ten times the tests") {
    for (const Engine engine : both_engines) {
      const Counts<std::uint64_t> few = search(1'000, 32, engine).counts;
      const Counts<std::uint64_t> many = search(10'000, 32, engine).counts;
      CHECK(many.disc_tests < 10'000 * surface_discs().size() / 50);
      CHECK(many.disc_tests < 9 * few.disc_tests);
    }
  }

  TEST_CASE("vectors list and test somewhat more rays, because they do not note which rays were tested") {
    const Counts<std::uint64_t> vectors = search(10'000, 32, Engine::simd).counts;
    const Counts<std::uint64_t> plain = search(10'000, 32, Engine::plain).counts;
    CHECK(vectors.listed >= plain.listed);
    CHECK(vectors.listed < 1.3 * static_cast<double>(plain.listed));
    CHECK(vectors.disc_tests > plain.disc_tests);
    CHECK(vectors.disc_tests < 3 * plain.disc_tests);
    CHECK(vectors.doubtful < vectors.disc_tests / 100);
  }

  TEST_CASE("nothing is built where no disc searches: one disc in a corner needs few cells") {
    const std::vector<Disc> pair{{.centre = glm::dvec3{-1}, .radius = 1e-3}, {.centre = glm::dvec3{1}, .radius = 1e-3}};
    const auto lines = LineField(enclosing_sphere(pair), 7).lines(0, 20'000);
    for (const Engine engine : both_engines) {
      const Outcome found =
          run(make_problem(lines, pair), {Technique::ray_map, RayMapParameters{8}}, {.engine = engine});
      CHECK(found.counts.culls < 200);
      CHECK(found.counts.disc_tests < 100);
    }
  }
}
