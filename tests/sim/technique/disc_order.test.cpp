#include "detp/sim/technique/piloted_discs.hpp"

#include <doctest/doctest.h>

#include <stdexcept>
#include <vector>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/registry.hpp"
#include "detp/sim/technique/technique.hpp"

using namespace detp;
using namespace detp::sim;

TEST_SUITE("identity") {
  TEST_CASE("a tree along a known order is the tree that sorting makes, with every radius and engine") {
    for (const std::size_t count : {1UL, 7UL, 3000UL, 9000UL}) {
      CAPTURE(count);
      const auto sorted = uniform_discs(Body::cube_faces, 2, count, 0.01, 5);
      const DiscOrder order(make_problem_without_rays(sorted, 10), {});
      for (const double radius : {0.001, 0.01, 0.5}) {
        const auto discs = uniform_discs(Body::cube_faces, 2, count, radius, 5);
        const auto lines = LineField(enclosing_sphere(discs), 1).lines(0, 100);
        const Problem problem = make_problem(lines, discs);
        const BoxTreeParameters shape{8, 16};
        for (const Engine engine : {Engine::simd, Engine::plain}) {
          const auto kept = order.prepare(problem, shape, {.engine = engine});
          const auto made = prepare(problem, Candidate{Technique::box_tree, shape}, {.engine = engine});
          CHECK(kept->built().counts.sorted == 0);
          CHECK(kept->built().counts.made == made->built().counts.made);
          const Outcome a = search(*kept, problem, {.engine = engine});
          const Outcome b = search(*made, problem, {.engine = engine});
          CHECK(a.hits == b.hits);
          CHECK(a.irradiance == b.irradiance);
          CHECK(a.counts == b.counts);
        }
      }
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("another number of discs, parameters out of range, a stop request") {
    const auto discs = uniform_discs(Body::cube, 2, 100, 0.1, 5);
    const Problem problem = make_problem_without_rays(discs, 10);
    const DiscOrder order(problem, {});
    const Problem fewer = make_problem_without_rays(std::span(discs).first(50), 10);
    CHECK_THROWS_AS(static_cast<void>(order.prepare(fewer, {8, 16}, {})), std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(order.prepare(problem, {1, 16}, {})), std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(order.prepare(problem, {8, 16}, {.threads = -1})), std::invalid_argument);
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_AS(static_cast<void>(order.prepare(problem, {8, 16}, {.stop = source.get_token()})), Stopped);
    CHECK_THROWS_AS(DiscOrder(problem, {.stop = source.get_token()}), Stopped);
  }
}
