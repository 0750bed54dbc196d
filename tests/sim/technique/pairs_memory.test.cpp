#include <doctest/doctest.h>

#include <stdexcept>
#include <vector>

#include "detp/sim/technique/technique.hpp"
#include "support/memory_limit.hpp"

using namespace detp;
using namespace detp::sim;
using support::MemoryLimit;

TEST_SUITE("bad input") {
  TEST_CASE("pairs that would not fit in memory are refused before allocation; the hits alone are found") {
    const std::vector<Disc> discs(1000, Disc{{0, 0, 0}, {0, 0, 1}, 1});
    const std::vector<Ray> rays(2000, Ray{{0.1, 0.2, -3}, {0, 0, 1}});
    const Problem problem = make_problem(rays, discs);
    const MemoryLimit limit(0x1p23);  // the pairs take 16 MB
    for (const Technique technique : {Technique::brute_force, Technique::octree})
      for (const bool plain : {false, true}) {
        Candidate candidate{technique, {}};
        if (technique == Technique::octree) candidate.parameters = OctreeParameters{1};
        CAPTURE(name(technique));
        CAPTURE(plain);
        CHECK(run(problem, candidate, {.engine = plain ? Engine::plain : Engine::simd}).total_hits == 2'000'000);
        CHECK_THROWS_WITH_AS(
            (void)run(problem, candidate, {.pairs = true, .engine = plain ? Engine::plain : Engine::simd}),
            doctest::Contains("the pairs would take"), std::length_error);
      }
  }
}
