#include "detp/sim/lists/pilot/box_tree_pilot.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "detp/sim/geometry/random.hpp"
#include "detp/sim/lists/simd/binary_tree.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"

using namespace detp;
using doctest::Approx;

namespace {

constexpr std::size_t all_subtrees = 1000;

struct Piloted {
  Piloted(std::size_t samples, double radius, std::size_t count, std::uint64_t seed, sim::Body body)
      : discs(sim::uniform_discs(body, 2, samples, radius, seed)),
        rays(sim::LineField(sim::enclosing_sphere(discs), seed).lines(0, count)),
        problem(sim::make_problem(rays, discs)),
        frame(problem),
        sorted(sim::stream::sort_discs(problem, frame)) {}

  [[nodiscard]] sim::stream::BoxTreePilot pilot(std::size_t sampled, std::size_t subtrees) const {
    std::vector<sim::Ray> sample;
    for (const std::size_t ray : sim::stratified_sample(rays.size(), sampled, 1, sim::Stream::tests))
      sample.push_back(rays[ray]);
    return {problem, frame, sorted, {sample, static_cast<double>(rays.size())}, subtrees};
  }

  [[nodiscard]] Counts<double> counted(const BoxTreeParameters& shape) const {
    return as_expected(sim::run(problem, Candidate{Technique::box_tree, shape}).counts);
  }

  std::vector<sim::Disc> discs;
  std::vector<sim::Ray> rays;
  sim::Problem problem;
  sim::stream::Frame frame;
  sim::stream::SortedDiscs sorted;
};

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("a pilot of all rays through the whole tree predicts every count exactly, for every shape") {
    for (const std::size_t samples : {1UL, 5UL, 70UL, 500UL}) {
      const Piloted all(samples, 0.1, 300, 3, sim::Body::cube_faces);
      const auto pilot = all.pilot(300, all_subtrees);
      for (const int fan_out : {2, 3, 8, 16})
        for (const int leaf : {4, 8, 30, 64, 1000}) {
          INFO("samples ", samples, ", fan_out ", fan_out, ", leaf ", leaf);
          const auto predicted = pilot.counts({fan_out, leaf});
          const Counts<double> counted = all.counted({fan_out, leaf});
          for (const CountTerm<double>& term : count_terms<double>) {
            if (term.name == "doubtful") continue;
            CAPTURE(term.name);
            CHECK(predicted.counts.*term.term == Approx(counted.*term.term).epsilon(1e-6));
            CHECK(predicted.error.*term.term == 0);
          }
        }
    }
  }

  TEST_CASE("the sample decides nothing about the discs: placements, references and sorted are their number") {
    const Piloted many(3000, 0.02, 1000, 5, sim::Body::cube);
    const Counts<double> counts = many.pilot(100, 3).counts({8, 16}).counts;
    CHECK(counts.loaded == 1000);
    CHECK(counts.sorted == 3000);
    CHECK(counts.placements == 3000);
    CHECK(counts.references == 3000);
  }

  TEST_CASE("the builder of box trees splits a node by the constants that the closed forms use") {
    const float area = 2;
    const float children = 3;
    const float below = 5;
    const double as_inner = box_tree_split::cull * area + box_tree_split::list * children + below;
    for (int discs = 1; discs <= 2 * box_tree_split::largest_leaf; ++discs) {
      CAPTURE(discs);
      const sim::stream::NodeCost node(area, static_cast<std::uint32_t>(discs), children, below);
      CHECK(node.inner == (static_cast<double>(discs) * area > as_inner));
      CHECK(node.cost == doctest::Approx(node.inner ? as_inner : static_cast<double>(discs) * area).epsilon(1e-6));
      const sim::stream::NodeCost costly(area, static_cast<std::uint32_t>(discs), children, 1000);
      CHECK(costly.inner == (discs > box_tree_split::largest_leaf));
    }
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("a pilot of all rays through all subtrees is off only by the boxes above the subtrees") {
    for (const auto body : {sim::Body::cube, sim::Body::cube_faces}) {
      const Piloted all(20'000, 0.01, 2000, 7, body);
      const auto pilot = all.pilot(2000, all_subtrees);
      for (const BoxTreeParameters shape : {BoxTreeParameters{4, 8}, {8, 32}, {16, 128}, {8, 2000}}) {
        INFO("shape.fan_out ", shape.fan_out, ", shape.leaf ", shape.leaf);
        const Counts<double> predicted = pilot.counts(shape).counts;
        const Counts<double> counted = all.counted(shape);
        CHECK(predicted.cull_tests == Approx(counted.cull_tests).epsilon(0.03));
        CHECK(predicted.listed == Approx(counted.listed).epsilon(0.03));
        CHECK(predicted.disc_tests == Approx(counted.disc_tests).epsilon(0.03));
        CHECK(predicted.visits == Approx(counted.visits).epsilon(0.03));
        CHECK(predicted.made == Approx(counted.made).epsilon(0.001));
        CHECK(predicted.hits == counted.hits);
      }
    }
  }

  TEST_CASE("samples of rays and subtrees have no bias, and the stated error is that of their tests") {
    constexpr int sets = 24;
    double sum = 0;
    double in_errors = 0;
    double visits = 0;
    for (std::uint64_t set = 1; set <= sets; ++set) {
      const Piloted some(20'000, 0.01, 4000, set, sim::Body::cube_faces);
      const auto predicted = some.pilot(400, 10).counts({8, 16});
      const Counts<double> counted = some.counted({8, 16});
      const double ratio = tests(predicted.counts) / tests(counted);
      sum += ratio;
      visits += predicted.counts.visits / counted.visits;
      in_errors += std::pow((ratio - 1) * tests(counted) / tests(predicted.error), 2);
    }
    CHECK(sum / sets == Approx(1).epsilon(0.03));
    CHECK(visits / sets == Approx(1).epsilon(0.03));       // most lists hold about one ray
    const double deviation = std::sqrt(in_errors / sets);  // in stated errors
    CHECK(deviation > 0.3);
    CHECK(deviation < 1.3);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a stop request ends a pilot") {
    const Piloted some(3000, 0.02, 100, 5, sim::Body::cube);
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_AS(
        sim::stream::BoxTreePilot(some.problem, some.frame, some.sorted, {some.rays, 100}, 3, source.get_token()),
        sim::Stopped);
  }
}
