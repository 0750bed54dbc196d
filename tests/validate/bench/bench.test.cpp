#include "detp/validate/bench/bench_answer.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "detp/validate/calibration/built_in_costs.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

CompetitorResult competitor_result(const Competitor& competitor, std::vector<double> seconds, std::uint64_t wrong = 0) {
  return {.competitor = competitor, .seconds = std::move(seconds), .hits = 100, .wrong_hits = wrong};
}

/// A race in which our fastest technique took 1 s, and Embree's fastest mode `embree` seconds.
BenchEntry entry(double embree, int threads = 1) {
  BenchEntry made;
  made.threads = threads;
  made.race.complete = true;
  made.race.results = {competitor_result(Candidate{}, {9, 1, 1}),
                       competitor_result(Candidate{Technique::grid, GridParameters{}}, {3}),
                       competitor_result(EmbreeMode{}, {embree, 2 * embree, 0}, 3),
                       competitor_result(EmbreeMode{.coherent = true}, {2 * embree})};
  return made;
}

Job small_job() {
  JobRequest request;
  request.scene = "@uniform";
  request.rays = 500;
  request.samples = 300;
  request.disc_radius = Length{0.05, true};
  return make_job(request);
}

std::size_t count_of(const BenchSet& set, const auto& predicate) {
  return static_cast<std::size_t>(std::count_if(set.workloads.begin(), set.workloads.end(), predicate));
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a ratio compares the best medians of both sides; the summary has the geometric mean and the worst") {
    const std::vector<BenchEntry> entries{entry(8), entry(2), entry(100, 2)};
    CHECK(entries[0].ratio().value() == doctest::Approx(8));
    const auto one = against_embree(entries, 1);
    REQUIRE(one);
    CHECK(one->races == 2);
    CHECK(one->geometric_mean == doctest::Approx(4));
    CHECK(one->worst == doctest::Approx(2));
    CHECK(one->worst_entry == 1);
    CHECK(against_embree(entries, 2)->geometric_mean == doctest::Approx(100));
    CHECK_FALSE(against_embree(entries, 3));
  }

  TEST_CASE("our choice is compared with Embree, too, and keeps a share of what the best gains") {
    std::vector<BenchEntry> entries{entry(8), entry(2), entry(8)};
    entries[0].race.results.push_back(competitor_result(OwnChoice{}, {2, 2, 9}));
    entries[1].race.results.push_back(competitor_result(OwnChoice{}, {0.5}));
    CHECK(entries[0].ratio().value() == doctest::Approx(8));
    CHECK(entries[0].ratio(Ours::choice).value() == doctest::Approx(4));
    CHECK_FALSE(entries[2].ratio(Ours::choice));
    const auto chosen = against_embree(entries, 1, Ours::choice);
    REQUIRE(chosen);
    CHECK(chosen->races == 2);
    CHECK(chosen->geometric_mean == doctest::Approx(4));
    CHECK(chosen->worst == doctest::Approx(4));
    CHECK(chosen->kept == doctest::Approx(1));  // half in one, twice in the other
  }

  TEST_CASE("a race that was stopped has no ratio and is not in the summary") {
    std::vector<BenchEntry> entries{entry(8)};
    entries[0].race.complete = false;
    CHECK_FALSE(entries[0].ratio());
    CHECK_FALSE(against_embree(entries, 1));
  }

  TEST_CASE("our wrong hits are a disagreement, those of Embree are added up") {
    std::vector<BenchEntry> entries{entry(8), entry(2)};
    CHECK(do_own_hits_agree(entries));
    CHECK(embree_wrong_hits(entries).wrong == 6);
    CHECK(embree_wrong_hits(entries).hits == 400);
    entries[1].race.results[1].wrong_hits = 1;
    CHECK_FALSE(do_own_hits_agree(entries));
  }

  TEST_CASE("wrong hits are counted disc by disc: one too many does not cancel one too few") {
    const RightHits right{Technique::brute_force, {5, 5, 5}};
    CHECK(right.wrong_hits(std::vector<std::uint64_t>{5, 5, 5}) == 0);
    CHECK(right.wrong_hits(std::vector<std::uint64_t>{6, 4, 5}) == 2);
  }

  TEST_CASE("all run once, the fastest two of each side for all repeats, and hits are compared" *
            doctest::skip(!has_embree)) {
    const Job job = small_job();
    RightHits right = right_hits(job, Candidate{}, 0);
    const std::vector<Competitor> competitors{
        Candidate{},  Candidate{Technique::grid, GridParameters{4}}, Candidate{Technique::octree, OctreeParameters{2}},
        EmbreeMode{}, EmbreeMode{.query = EmbreeQuery::occluded},    EmbreeMode{.rays = EmbreeRays::packet_8},
        OwnChoice{}};
    const RaceOptions options{.repeats = 3, .most_seconds = 60, .costs = built_in_unit_costs()};
    const EmbreePeer embree(1);
    Race found = race(job, right, &embree, competitors, options);
    CHECK(found.complete);
    REQUIRE(found.results.size() == competitors.size());
    for (const auto side : {is_own_technique, is_embree})
      CHECK(std::count_if(found.results.begin(), found.results.end(), [&](const CompetitorResult& one) {
              return side(one.competitor) && one.seconds.size() == 3;
            }) == 2);
    CHECK(technique_of(found.results.back().competitor) == "choice");
    CHECK(found.results.back().seconds.size() == 3);
    for (const CompetitorResult& one : found.results) CHECK(one.wrong_hits <= (is_embree(one.competitor) ? 2U : 0U));
    ++right.hits[0];
    found = race(job, right, &embree, competitors, options);
    for (const CompetitorResult& one : found.results) CHECK(one.wrong_hits >= 1);
  }

  TEST_CASE("the sets: their workloads, and those that are missing without the meshes") {
    const BenchSet quick = bench_set(BenchEffort::quick, {}, "");
    CHECK(quick.workloads.size() == 28);  // 7 pairs of scene and field, 2 radii, 2 numbers of rays
    CHECK(quick.missing.size() == 1);
    const BenchSet thorough = bench_set(BenchEffort::thorough, {}, "/nowhere");
    CHECK(thorough.missing.size() == 8);
    CHECK(thorough.missing[0].find("/nowhere/stanford_bunny.obj does not exist") != std::string::npos);
    CHECK(count_of(thorough, [](const BenchWorkload& one) { return one.scene == "@tree"; }) == 2 * (6 * 3 + 2));
    CHECK(count_of(thorough, [](const BenchWorkload& one) { return one.samples == 1e6; }) == 6 * 3 + 2);
  }

  TEST_CASE("lists in the axes replace those of the set") {
    const BenchAxes axes{
        .scene = "@tree", .fields = {sim::Field::photons}, .samples = {}, .disc_radii = {{0.1}}, .rays = {1e6, 10}};
    const BenchSet set = bench_set(BenchEffort::thorough, axes, "");
    REQUIRE(set.workloads.size() == 2);
    CHECK(set.workloads[0].rays == 10);
    CHECK(set.workloads[1].rays == 1e6);
    CHECK(set.workloads[0].disc_radius.value == 0.1);
    CHECK(set.missing.empty());
  }

  TEST_CASE("a workload with too many hits is skipped, by the model's expectation or by a run with fewer rays") {
    const BenchSet set = bench_set(BenchEffort::quick,
                                   {.scene = "@uniform",
                                    .fields = {},
                                    .samples = {300},
                                    .disc_radii = {{0.05, true}},
                                    .rays = {100, 1000, 100000}},
                                   "");
    const BenchResult result =
        run_bench(set.workloads, {.race = {.repeats = 1}, .embree_modes = best_embree_modes(), .most_hits = 5000});
    CHECK(result.entries.size() == 2);
    REQUIRE(result.skipped.size() == 1);
    CHECK(result.skipped[0].workload.rays == 1e5);
    CHECK_FALSE(result.stopped);
  }
}
