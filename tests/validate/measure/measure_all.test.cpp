#include "detp/validate/measure/measure_all.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/measure/rounds.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

const Candidate small_grid{Technique::grid, GridParameters{4}};
const Candidate box_tree_4_16{Technique::box_tree, BoxTreeParameters{4, 16}};

Timed timed(const Candidate& candidate, std::vector<double> selecting, std::vector<double> judging) {
  return {.contender = {candidate}, .selecting = std::move(selecting), .judging = std::move(judging)};
}

/// The fastest by its first time: its neighbours must have been run.
Contender leader_of(const Exhaustive& found) {
  const auto seconds = [](const Timed& one) { return one.abandoned ? HUGE_VAL : one.first_seconds; };
  return std::min_element(found.candidates.begin(), found.candidates.end(),
                          [&](const Timed& a, const Timed& b) { return seconds(a) < seconds(b); })
      ->contender;
}

struct SmallProblem {
  std::vector<sim::Disc> discs = sim::uniform_discs(sim::Body::cube, 1, 200, 0.05, 1);
  std::vector<sim::Ray> rays = sim::LineField(sim::enclosing_sphere(discs), 1).lines(0, 100);
  sim::Problem problem = sim::make_problem(rays, discs);
};

bool contains(const std::vector<Candidate>& all, const Candidate& wanted) {
  return std::find(all.begin(), all.end(), wanted) != all.end();
}

constexpr std::size_t contenders = 5;

/// The contenders of each round in their order; ends after `most_runs` runs.
std::vector<std::vector<std::size_t>> rounds_of(int rounds, int most_runs) {
  std::vector<std::vector<std::size_t>> orders;
  in_turns(contenders, rounds, [&](std::size_t i, int round) {
    orders.resize(static_cast<std::size_t>(round) + 1);
    orders[static_cast<std::size_t>(round)].push_back(i);
    return --most_runs > 0;
  });
  return orders;
}

std::vector<bool> near(const TimesOfAll& times) { return not_behind(times, 1.5); }

RoundTimes times_of(std::initializer_list<std::initializer_list<double>> rounds) {
  RoundTimes times;
  for (const auto& round : rounds) {
    times.begin_round();
    for (const double seconds : round) times.add(seconds, seconds / 2);
  }
  return times;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("the best is the fastest on the selecting half, even if another is faster on the judging half") {
    const std::vector<Timed> candidates{timed(box_tree_4_16, {3, 5, 6}, {1, 1}), timed(small_grid, {4, 2, 5}, {9, 7}),
                                        timed(default_candidate(Technique::bvh), {}, {0.5})};
    const auto best = fastest_selected(candidates);
    REQUIRE(best);
    CHECK(*best == 1);
    CHECK(candidates[*best].judging_seconds() == 8);
    CHECK(candidates[*best].judged_ratio(candidates[0]) == 8);
    CHECK_FALSE(fastest_selected({}));
    CHECK_FALSE(fastest_selected(std::span(candidates).last(1)));
  }

  TEST_CASE("a candidate that was abandoned is judged by its lower bound") {
    const Timed abandoned{.contender = {small_grid}, .abandoned = true, .first_seconds = 0.25};
    CHECK(abandoned.judging_seconds() == 0.25);
    CHECK(abandoned.judged_ratio(timed(box_tree_4_16, {}, {0.1, 0.125, 0.2})) == 2);
  }

  TEST_CASE("the search runs those asked for, then all exact techniques and neighbours, and all find the same hits") {
    const SmallProblem small;
    const std::vector<Contender> asked{{box_tree_4_16}, {small_grid}, {box_tree_4_16}};
    const Exhaustive found = measure_all(small.problem, asked, {.repeats = 1, .patience = 1e3});
    REQUIRE(found.candidates.size() > 2);
    CHECK(found.candidates[0].contender == asked[0]);
    CHECK(found.candidates[1].contender == asked[1]);
    for (const Technique technique : all_techniques)
      CHECK(std::any_of(found.candidates.begin(), found.candidates.end(), [&](const Timed& one) {
              return one.contender.candidate.technique == technique;
            }) == record_of(technique).exact);
    for (const Timed& one : found.candidates) {
      CHECK(std::count_if(found.candidates.begin(), found.candidates.end(),
                          [&](const Timed& other) { return other.contender == one.contender; }) == 1);
      if (!one.abandoned) CHECK(one.counts.hits == found.candidates[0].counts.hits);
    }
    const Contender leader = leader_of(found);
    const auto near = neighbours(leader.candidate);  // none of brute force, for instance
    CHECK((near.empty() || std::any_of(near.begin(), near.end(), [&](const Candidate& candidate) {
             return found.find({candidate}) != nullptr;
           })));
    REQUIRE(found.best);
    const Timed& best = found.candidates[*found.best];
    CHECK_FALSE(best.abandoned);
    CHECK_FALSE(best.judging.empty());
    CHECK(found.noise > 0);
    CHECK(found.find(best.contender) == &best);
    CHECK(found.find({{Technique::grid, GridParameters{1000}}}) == nullptr);
    for (const Contender& contender : asked)
      CHECK((found.find(contender)->abandoned || !found.find(contender)->judging.empty()));
    CHECK_FALSE(found.stopped);
  }

  TEST_CASE("with two threads allowed, the fastest are also tried on one") {
    const SmallProblem small;
    const std::vector<Contender> asked{{box_tree_4_16, 2}, {box_tree_4_16, 1}, {small_grid, 1}};
    const Exhaustive found = measure_all(small.problem, asked, {.repeats = 1, .patience = 1e3, .threads = 2});
    for (std::size_t i = 0; i < asked.size(); ++i) CHECK(found.candidates[i].contender == asked[i]);
    const Contender leader = leader_of(found);
    CHECK(found.find({leader.candidate, 3 - leader.threads}) != nullptr);
  }

  TEST_CASE("a search that is stopped before its first run has no best, and says that it was stopped") {
    const SmallProblem small;
    std::stop_source source;
    source.request_stop();
    const Exhaustive found =
        measure_all(small.problem, std::vector<Contender>{{small_grid}}, {.stop = source.get_token()});
    CHECK(found.stopped);
    CHECK_FALSE(found.best);
    CHECK(found.candidates.empty());
  }

  TEST_CASE("techniques left out of a ranking are the exact ones that are not in it") {
    const auto left_out = techniques_left_out({{Technique::grid, GridParameters{3}}, {}});
    CHECK(contains(left_out, {Technique::bsp, BspParameters{}}));
    CHECK(contains(left_out, {Technique::bvh, BvhParameters{}}) == has_embree);
    // all techniques except the two in the ranking and the two that are not exact
    CHECK(left_out.size() == all_techniques.size() - 4);
    for (const Candidate& candidate : left_out) CHECK(record_of(candidate.technique).exact);
  }

  TEST_CASE("neighbours have half and twice the fan-out, leaves 4 times smaller and larger, depths one level away") {
    const auto trees = neighbours({Technique::box_tree, BoxTreeParameters{4, 16}});
    CHECK(trees.size() == 4);
    for (const auto& tree : {BoxTreeParameters{2, 16}, {8, 16}, {4, 4}, {4, 64}})
      CHECK(contains(trees, {Technique::box_tree, tree}));
    const auto octrees = neighbours({Technique::octree, OctreeParameters{5}});
    CHECK(octrees.size() == 2);
    CHECK(contains(octrees, {Technique::octree, OctreeParameters{4}}));
    const auto grids = neighbours({Technique::grid, GridParameters{100}});
    CHECK(contains(grids, {Technique::grid, GridParameters{71}}));
    CHECK(contains(grids, {Technique::grid, GridParameters{140}}));
  }

  TEST_CASE("each contender runs once in each round, in changing orders, the first of which is the given one") {
    auto orders = rounds_of(20, 1000);
    REQUIRE(orders.size() == 20);
    CHECK(std::ranges::is_sorted(orders[0]));
    CHECK(std::set(orders.begin(), orders.end()).size() > 10);
    for (auto& order : orders) {
      std::ranges::sort(order);
      CHECK(order == std::vector<std::size_t>{0, 1, 2, 3, 4});
    }
  }

  TEST_CASE("rounds end with the first run that asks for it, and without contenders nothing runs") {
    CHECK(rounds_of(20, 7).back().size() == 2);
    int runs = 0;
    in_turns(0, 3, [&](std::size_t, int) { return ++runs > 0; });
    CHECK(runs == 0);
  }

  TEST_CASE("a contender that is far behind is timed four times, the others in every round") {
    const std::array seconds{1.0, 1.4, 1.6};
    const auto times = timed_rounds(3, {.rounds = 7}, near, [&](std::size_t i, auto&&) { return seconds[i]; });
    CHECK(times[0].size() == 7);
    CHECK(times[1].size() == 7);
    CHECK(times[2].size() == 4);
  }

  TEST_CASE("a machine that changes its speed between rounds does not put equal contenders behind") {
    int runs = 0;
    const auto times =
        timed_rounds(4, {.rounds = 6}, near, [&](std::size_t, auto&&) { return runs++ < 4 ? 2.0 : 1.0; });
    for (const auto& of_one : times) CHECK(of_one.size() == 6);
  }

  TEST_CASE("the rounds end with the first run that returns nothing") {
    int runs = 0;
    const auto times =
        timed_rounds(3, {}, near, [&](std::size_t, auto&&) { return ++runs <= 4 ? std::optional(1.0) : std::nullopt; });
    CHECK(times[0].size() + times[1].size() + times[2].size() == 4);
    for (const auto& of_one : times) CHECK(!of_one.empty());
    CHECK(runs == 5);
  }

  TEST_CASE("no round begins after the time limit, and without contenders nothing is timed") {
    const auto times =
        timed_rounds(2, {.rounds = 9, .most_seconds = -1}, near, [](std::size_t, auto&&) { return 1.0; });
    CHECK(times[0].size() == 1);
    CHECK(times[1].size() == 1);
    CHECK(timed_rounds(0, {}, near, [](std::size_t, auto&&) { return 1.0; }).empty());
  }

  TEST_CASE("times agree once the shortest times of two rounds do, not two times of one round") {
    CHECK_FALSE(times_of({}).agree());
    CHECK_FALSE(times_of({{1, 1, 1}}).agree());
    CHECK_FALSE(times_of({{1, 1}, {2, 1.2}}).agree());
    CHECK(times_of({{1, 9}, {5, 1.04}}).agree());
    CHECK(times_of({{4}, {3}, {1}, {2}, {1.02}}).agree());
  }

  TEST_CASE("the shortest times count, of all rounds") {
    const RoundTimes times = times_of({{4, 3}, {1.5, 2}});
    CHECK(times.seconds() == 1.5);
    CHECK(times.preparing() == 0.75);
    CHECK(times.timed());
    CHECK(times.usual_seconds() == 1.5);
    CHECK(times_of({{4, 3}, {1.5, 2}, {2, 9}}).usual_seconds() == 2);
  }

  TEST_CASE("without a run there is no time") {
    CHECK_FALSE(times_of({}).timed());
    CHECK_FALSE(times_of({{}}).timed());
    CHECK_FALSE(times_of({{}, {}}).agree());
    CHECK_FALSE(times_of({{0}}).timed());
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("neighbours stay within the parameters' ranges, also at their ends") {
    for (const Candidate& candidate :
         {Candidate{Technique::octree, OctreeParameters{0}}, Candidate{Technique::octree, OctreeParameters{20}},
          Candidate{Technique::cell_spheres, CellSpheresParameters{0}},
          Candidate{Technique::cell_spheres, CellSpheresParameters{16}}, Candidate{Technique::grid, GridParameters{1}},
          Candidate{Technique::grid, GridParameters{1 << 20}},
          Candidate{Technique::sphere_cache, SphereCacheParameters{0.999, 1}},
          Candidate{Technique::bsp, BspParameters{32, 1}}, Candidate{Technique::bsp, BspParameters{32, 1 << 20}},
          default_candidate(has_embree ? Technique::bvh : Technique::bsp), Candidate{}})
      for (const Candidate& neighbour : neighbours(candidate)) {
        CHECK_NOTHROW(check(neighbour));
        CHECK_FALSE(neighbour == candidate);
      }
  }
}
