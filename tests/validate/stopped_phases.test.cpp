#include <doctest/doctest.h>

#include "detp/sim/effects/observe.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/validate/bench/bench.hpp"
#include "detp/validate/claims/experiments.hpp"
#include "detp/validate/job/job.hpp"
#include "detp/validate/structural/structural.hpp"
#include "detp/validate/sweep/sweep.hpp"
#include "support/work_log.hpp"

namespace detp::validate {
namespace {

using sim::StopCheck;
using support::bounded_work_of;
using support::StopAfterWork;

constexpr std::uint64_t block = StopCheck::most_work;

Experiment small(const std::stop_token& stop) {
  return {.workload = cube_workload(32'000, 2000, 0.03, 2), .discs = {}, .seed = 5, .stop = stop};
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("structural counts do bounded work between checks, and a stop request ends them") {
    const auto discs = sim::uniform_discs(sim::Body::cube, 2, 60'000, 0.01, 1);
    for (const Candidate& candidate :
         {Candidate{Technique::sphere_cache, SphereCacheParameters{0.6, 6}},
          Candidate{Technique::cell_spheres, CellSpheresParameters{4}},
          Candidate{Technique::sphere_tree, SphereTreeParameters{8, 4}},
          Candidate{Technique::box_tree, BoxTreeParameters{4, 16}}, Candidate{Technique::octree, OctreeParameters{4}},
          Candidate{Technique::grid, GridParameters{30}}}) {
      INFO("name(candidate.technique) ", name(candidate.technique), ", describe(candidate) ", describe(candidate));
      const double work = bounded_work_of([&] { static_cast<void>(structural_counts(discs, 1e5, candidate)); });
      CHECK(work > static_cast<double>(discs.size()));
      const StopAfterWork stop(work / 2);
      CHECK_THROWS_AS(static_cast<void>(structural_counts(discs, 1e5, candidate, stop.token())), sim::Stopped);
      CHECK(stop.total() < work / 2 + 4.0 * block);
    }
  }

  TEST_CASE("making rays and discs does bounded work between stop checks, and a stop request ends it") {
    JobRequest request;
    request.scene = "@uniform";
    request.samples = 100'000;
    request.rays = 400'000;
    const double work = bounded_work_of([&] { static_cast<void>(make_job(request)); });
    // Units of work: 4 for each sample (made, checked) and 2 for each ray (made, checked).
    CHECK(work >= 4 * 100'000 + 2 * 400'000);
    for (const double share : {0.1, 0.5, 0.9}) {
      const StopAfterWork stop(share * work);
      CHECK_THROWS_AS(static_cast<void>(make_job(request, stop.token())), sim::Stopped);
    }
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("stopped races report how many workloads were done") {
    const BenchWorkload one{.scene = "@uniform",
                            .discs = "@uniform",
                            .field = sim::Field::isotropic,
                            .samples = 500,
                            .disc_radius = Length{0.02},
                            .rays = 2000};
    const std::vector<BenchWorkload> workloads{one, one, one};
    std::stop_source source;
    const BenchOptions options{.race = {.repeats = 1,
                                        .stop = source.get_token(),
                                        .progress =
                                            [&](const sim::Phase& phase) {
                                              if (phase.from > 0.7) source.request_stop();
                                            }},
                               .techniques = {Technique::brute_force},
                               .embree_modes = {EmbreeMode{}}};
    const BenchResult result = run_bench(workloads, options);
    CHECK(result.stopped);
    CHECK(result.done == 2);
    CHECK(result.workloads == 3);
  }
}

/// These experiments take too long for the quick suites.
TEST_SUITE("statistical") {
  TEST_CASE("experiments and races do bounded work between stop checks") {
    bounded_work_of([] { static_cast<void>(all_findings(small({}))); });
    const std::vector<BenchWorkload> workloads{{.scene = "@uniform",
                                                .discs = "@uniform",
                                                .field = sim::Field::isotropic,
                                                .samples = 5000,
                                                .disc_radius = Length{0.02},
                                                .rays = 20'000}};
    const BenchOptions options{.race = {.repeats = 1}, .embree_modes = {EmbreeMode{}}};
    bounded_work_of([&] { static_cast<void>(run_bench(workloads, options)); });
  }

  TEST_CASE("stopped experiments return the findings of those done, and their number") {
    sim::Progress all;
    std::size_t findings = 0;
    const double work = bounded_work_of([&] { findings = all_findings(small({}), {}, &all).size(); });
    CHECK(all.done == all.of);
    CHECK(all.unit == "experiments");
    const StopAfterWork stop(0.9 * work);
    sim::Progress some;
    const auto found = all_findings(small(stop.token()), {}, &some);
    CHECK(some.of == all.of);
    CHECK(some.done < some.of);
    CHECK(found.size() < findings);
    CHECK((some.done > 0) == !found.empty());
  }
}

}  // namespace detp::validate
