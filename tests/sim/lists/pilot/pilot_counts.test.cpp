#include "detp/sim/lists/pilot/pilot_counts.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "detp/sim/lists/pilot/box_tree_pilot.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"

using namespace detp;
using doctest::Approx;

namespace {

/// The counts of a box tree, predicted by a pilot of all rays through the whole tree.
sim::stream::PilotCounts predicted_at(sim::Body body, double radius, std::size_t rays, const BoxTreeParameters& shape,
                                      std::size_t samples = 4000) {
  const auto discs = sim::uniform_discs(body, 2, samples, radius, 7);
  const auto lines = sim::LineField({{0, 0, 0}, 2}, 7).lines(0, rays);  // the same for all radii
  const sim::Problem problem = sim::make_problem(lines, discs);
  const sim::stream::Frame frame(problem);
  const auto sorted = sim::stream::sort_discs(problem, frame);
  return sim::stream::BoxTreePilot(problem, frame, sorted, {lines, static_cast<double>(rays)}, 1000)
      .counts(shape, true);
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("the pilot's own radius and number of rays have the pilot's counts, and a limit of the others is near") {
    const auto counts = predicted_at(sim::Body::cube_faces, 0.05, 500, {8, 16});
    CHECK(counts.at(1, 500) == counts.counts);
    const Counts<double> near = counts.at(1 + 1e-9, 500);
    for (const CountTerm<double>& term : count_terms<double>) {
      CAPTURE(term.name);
      CHECK(near.*term.term == Approx(counts.counts.*term.term).epsilon(1e-6));
    }
  }

  TEST_CASE("tests and hits are proportional to the number of rays; visited discs are not") {
    const auto counts = predicted_at(sim::Body::cube, 0.05, 50, {4, 8});
    const Counts<double> more = counts.at(1, 500);
    CHECK(more.loaded == 500);
    CHECK(more.cull_tests == Approx(10 * counts.counts.cull_tests));
    CHECK(more.disc_tests == Approx(10 * counts.counts.disc_tests));
    CHECK(more.hits == Approx(10 * counts.counts.hits));
    CHECK(more.visits > 1.5 * counts.counts.visits);
    CHECK(more.visits <= 4000);
    CHECK(more.made == counts.counts.made);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("counts at another radius are near those of a pilot with that radius") {
    constexpr double radius = 0.05;
    constexpr std::size_t rays = 3000;
    using Term = double Counts<double>::*;
    constexpr Term terms[] = {&Counts<double>::cull_tests, &Counts<double>::culls, &Counts<double>::listed,
                              &Counts<double>::visits, &Counts<double>::disc_tests};
    for (const sim::Body body : {sim::Body::cube_faces, sim::Body::cube})
      for (const BoxTreeParameters shape : {BoxTreeParameters{8, 8}, BoxTreeParameters{8, 64}}) {
        const auto planned = predicted_at(body, radius, rays, shape);
        for (const double ratio : {0.25, 0.5, 0.8, 1.25, 2.0, 4.0})
          for (const std::size_t others : {rays, rays / 5, 5 * rays}) {
            INFO("shape.leaf ", shape.leaf, ", ratio ", ratio, ", others ", others);
            const double error = ratio < 0.5 || ratio > 2 ? 0.35 : 0.15;
            const Counts<double> extrapolated = planned.at(ratio, static_cast<double>(others));
            const Counts<double> there = predicted_at(body, ratio * radius, others, shape).counts;
            for (const Term term : terms) CHECK(extrapolated.*term == Approx(there.*term).epsilon(error));
          }
      }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a ratio and a number of rays out of range are refused") {
    const auto counts = predicted_at(sim::Body::cube, 0.05, 50, {8, 16}, 100);
    for (const double ratio : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
      CHECK_THROWS_AS(static_cast<void>(counts.at(ratio, 50)), std::invalid_argument);
    for (const double rays : {0.0, 0.5, -1.0, 2e18, std::nan("")})
      CHECK_THROWS_AS(static_cast<void>(counts.at(1, rays)), std::invalid_argument);
  }
}
