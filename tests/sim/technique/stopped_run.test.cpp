#include <doctest/doctest.h>

#include <vector>

#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/streamed.hpp"
#include "detp/sim/technique/technique.hpp"
#include "support/work_log.hpp"

namespace detp::sim {
namespace {

using support::bounded_work_of;
using support::LoggedWork;
using support::StopAfterWork;

const std::vector<Disc>& small_discs() {
  static const std::vector<Disc> all = uniform_discs(Body::cube, 2, 1000, 0.08, 4);
  return all;
}

std::vector<Ray> lines(std::size_t count) { return LineField(enclosing_sphere(small_discs()), 5).lines(0, count); }

struct SearchCase {
  Candidate candidate;
  Engine engine = Engine::simd;
};

const std::vector<SearchCase>& search_cases() {
  static const std::vector<SearchCase> all{{{Technique::brute_force, BruteForceParameters{}}},
                                           {{Technique::brute_force, BruteForceParameters{}}, Engine::plain},
                                           {{Technique::sphere_cache, SphereCacheParameters{0.6, 6}}},
                                           {{Technique::sphere_cache, SphereCacheParameters{0.6, 6}}, Engine::plain},
                                           {{Technique::cell_spheres, CellSpheresParameters{3}}},
                                           {{Technique::cell_spheres, CellSpheresParameters{3}}, Engine::plain},
                                           {{Technique::sphere_tree, SphereTreeParameters{8, 4}}},
                                           {{Technique::box_tree, BoxTreeParameters{4, 16}}},
                                           {{Technique::box_tree, BoxTreeParameters{4, 16}}, Engine::plain},
                                           {{Technique::box_tree, BoxTreeParameters{1 << 20, 1 << 20}}},
                                           {{Technique::octree, OctreeParameters{3}}},
                                           {{Technique::octree, OctreeParameters{0}}},
                                           {{Technique::octree, OctreeParameters{3, Traversal::neighbour_links}}},
                                           {{Technique::grid, GridParameters{8}}},
                                           {{Technique::bsp, BspParameters{}}},
                                           {{has_embree ? default_candidate(Technique::bvh) : Candidate{}}}};
  return all;
}

Outcome run_case(const SearchCase& search_case, std::span<const Ray> rays, const std::stop_token& stop,
                 bool pairs = false) {
  return run(make_problem(rays, small_discs()), search_case.candidate,
             {.pairs = pairs, .engine = search_case.engine, .stop = stop});
}

Outcome truth(std::span<const Ray> rays) {
  return run(make_problem(rays, small_discs()), {Technique::box_tree, BoxTreeParameters{4, 16}});
}

/// Checks that a stopped outcome is right for what it reports as done: the first rays, or the marked discs.
void check_stopped(const Outcome& outcome, std::span<const Ray> rays) {
  CHECK(outcome.stopped);
  CHECK(outcome.pairs.empty());
  CHECK(outcome.progress.done <= outcome.progress.of);
  if (outcome.progress.unit == "discs") {
    const Outcome all = truth(rays);
    CHECK(outcome.progress.of == small_discs().size());
    std::uint64_t done = 0;
    std::uint64_t hits = 0;
    for (std::size_t disc = 0; disc < small_discs().size(); ++disc) {
      CHECK(outcome.hits[disc] == (outcome.done_discs[disc] ? all.hits[disc] : 0));
      CHECK(outcome.irradiance[disc] == (outcome.done_discs[disc] ? all.irradiance[disc] : 0));
      done += outcome.done_discs[disc] ? 1 : 0;
      hits += outcome.hits[disc];
    }
    CHECK(done == outcome.progress.done);
    CHECK(hits == outcome.total_hits);
    return;
  }
  CHECK(outcome.done_discs.empty());
  CHECK(outcome.progress.of == rays.size());
  CHECK(outcome.batches.rays == outcome.progress.done);
  CHECK(outcome.batches.sum == static_cast<double>(outcome.total_hits));
  if (outcome.progress.done == 0) {
    CHECK(outcome.total_hits == 0);
    return;
  }
  const Outcome first = truth(rays.first(outcome.progress.done));
  CHECK(outcome.hits == first.hits);
  CHECK(outcome.irradiance == first.irradiance);
  CHECK(outcome.total_hits == first.total_hits);
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a run stopped at any point is right about the rays or discs that it reports as done") {
    for (const std::size_t count : {6000U, 70'000U}) {  // one block of rays and several
      const std::vector<Ray> rays = lines(count);
      for (const SearchCase& search_case : search_cases()) {
        if (search_case.engine == Engine::plain && count > 10'000) continue;
        INFO("name(search_case.candidate.technique) ", name(search_case.candidate.technique),
             ", describe(search_case.candidate) ", describe(search_case.candidate), ", count ", count);
        const double total = bounded_work_of([&] { CHECK_FALSE(run_case(search_case, rays, {}).stopped); });
        for (const double share : {0.1, 0.6}) {
          const StopAfterWork stop(share * total);
          const Outcome outcome = run_case(search_case, rays, stop.token(), true);
          if (!outcome.stopped) continue;  // no check came after that
          check_stopped(outcome, rays);
          CHECK(stop.total() < share * total + 10.0 * StopCheck::most_work);
        }
      }
    }
  }

  TEST_CASE("a run stopped before it begins has found nothing and says so") {
    const std::vector<Ray> rays = lines(1000);
    std::stop_source source;
    source.request_stop();
    for (const SearchCase& search_case : search_cases()) {
      CAPTURE(name(search_case.candidate.technique));
      const Outcome outcome = run_case(search_case, rays, source.get_token(), true);
      check_stopped(outcome, rays);
      CHECK(outcome.total_hits == 0);
      CHECK(outcome.hits.size() == small_discs().size());
    }
  }

  TEST_CASE("stopped while pairs are sorted, all rays are done and no pair is returned") {
    const std::vector<Ray> rays = lines(10'000);
    const double search = bounded_work_of([&] { static_cast<void>(run_case(search_cases().front(), rays, {})); });
    const StopAfterWork stop(search + StopCheck::most_work + 1);
    const Outcome outcome = run_case(search_cases().front(), rays, stop.token(), true);
    CHECK(outcome.progress.done == rays.size());
    check_stopped(outcome, rays);
  }

  TEST_CASE("a stream stopped at any point is right about the rays that it reports as done") {
    const std::vector<Ray> rays = lines(40'000);
    for (const SearchCase& search_case : search_cases()) {
      if (search_case.engine == Engine::plain) continue;
      INFO("name(search_case.candidate.technique) ", name(search_case.candidate.technique),
           ", describe(search_case.candidate) ", describe(search_case.candidate));
      for (const std::uint64_t at : {1, 20, 100}) {
        const StopAfterWork stop(0.5 * static_cast<double>(at) * StopCheck::most_work);
        const LinesOfField source_of_lines(enclosing_sphere(small_discs()), 5, rays.size());
        const StreamedOutcome streamed = run_streamed(small_discs(), source_of_lines, search_case.candidate,
                                                      {.run = {.stop = stop.token()}, .block = 10'000});
        if (streamed.outcome.stopped) check_stopped(streamed.outcome, rays);
      }
    }
  }

  TEST_CASE("the hits of all rays are within five standard errors of the estimate from the first rays") {
    const std::vector<Ray> rays = lines(20'000);
    const auto all = static_cast<double>(truth(rays).total_hits);
    for (const std::uint64_t first : {3840U, 19'968U}) {
      Batches batches;
      for (std::uint64_t ray = 0; ray < first; ray += 768)
        batches.add(768, static_cast<double>(truth(std::span(rays).subspan(ray, 768)).total_hits));
      const SumEstimate estimate = estimate_sum(batches, rays.size());
      CHECK(std::abs(estimate.value - all) < 5 * *estimate.standard_error);
      CHECK(*estimate.standard_error < 0.1 * all);
    }
    Batches one;
    one.add(10, 3);
    CHECK(estimate_sum(one, 100).value == 30);
    CHECK_FALSE(estimate_sum(one, 100).standard_error);
    one.add(10, 5);
    // The batch means 0.3 and 0.5 give a ray's hits the variance 10 · 0.1² + 10 · 0.1² = 0.2. With 20 of 100 rays
    // searched, the squared standard error is 100 · 80 / 20 · 0.2.
    CHECK(*estimate_sum(one, 100).standard_error == doctest::Approx(std::sqrt(80.0)));
  }
}

TEST_SUITE("identity") {
  TEST_CASE("the work between two checks of a run is bounded, and includes all tests") {
    const std::vector<Ray> rays = lines(70'000);
    for (const SearchCase& search_case : search_cases()) {
      if (search_case.engine == Engine::plain) continue;
      INFO("name(search_case.candidate.technique) ", name(search_case.candidate.technique),
           ", describe(search_case.candidate) ", describe(search_case.candidate));
      const LoggedWork logged;
      const Outcome outcome = run_case(search_case, rays, {});
      CHECK(logged.bounded());
      const std::uint64_t tests = outcome.counts.disc_tests + outcome.counts.cull_tests;
      CHECK(logged.total() + 10 * StopCheck::most_work > tests / 17);  // 16 tests of a list are one unit of work
    }
  }

  TEST_CASE("few discs with very long lists, or one disc in all cells, also have bounded work between checks") {
    const std::vector<Ray> rays = lines(3000);
    const std::vector<Disc> coincident(100'000, Disc{.centre = {0.1, 0.1, 0.1}, .normal = {0, 0, 1}, .radius = 0.5});
    for (const Candidate& candidate :
         support::built({Candidate{Technique::bvh, BvhParameters{}}, Candidate{Technique::octree, OctreeParameters{1}},
                         Candidate{Technique::bsp, BspParameters{}}, Candidate{Technique::grid, GridParameters{2}}})) {
      CAPTURE(name(candidate.technique));
      const StopAfterWork stop(20.0 * StopCheck::most_work + 1);
      CHECK(run(make_problem(rays, coincident), candidate, {.stop = stop.token()}).stopped);
      CHECK(stop.bounded());
    }
    const std::vector<Disc> large(2, Disc{.centre = {}, .normal = {0.6, 0.48, 0.64}, .radius = 1});
    const StopAfterWork stop(0);
    const Candidate fine{Technique::grid, GridParameters{200}};
    CHECK(run(make_problem(std::span(rays).first(10), large), fine, {.stop = stop.token()}).stopped);
    CHECK(stop.bounded());
  }
}

}  // namespace detp::sim
