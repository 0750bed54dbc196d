#include "detp/sim/search/ray_search.hpp"

#include <doctest/doctest.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "detp/sim/base/threads.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/technique/technique.hpp"
#include "support/candidates.hpp"
#include "support/same_bytes.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

const std::vector<Disc>& discs() {
  static const std::vector<Disc> all = uniform_discs(Body::cube, 2, 500, 0.2, 3);
  return all;
}

const std::vector<Ray>& rays() {
  static const std::vector<Ray> all = support::uneven_lines(discs(), 3000);
  return all;
}

/// Every ray hits disc number 0. `event` happens at ray number 1000.
class AllHit final : public RaySearch {
 public:
  explicit AllHit(std::function<void()> event) : event_(std::move(event)) {}

  void search(std::uint32_t first, std::uint32_t last, FoundPairs& hits) override {
    for (std::uint32_t ray = first; ray < last; ++ray) {
      if (ray == 1000) event_();
      hits.push_back({ray, 0});
    }
  }

  [[nodiscard]] Counts<std::uint64_t> counts() const override { return {}; }

 private:
  std::function<void()> event_;
};

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("hits, irradiance, pairs and counts have the same bytes on 1, 2 and 3 threads") {
    const Problem problem = make_problem(rays(), discs());
    const Outcome expected = support::truth_of(problem);
    CHECK(expected.total_hits > 5000);
    support::check_same_by_all(problem, expected, {support::one_of_each(), {Engine::simd}, {1, 2, 3, 0}});
    for (const Candidate& candidate : support::one_of_each()) {
      CAPTURE(name(candidate.technique));
      const Outcome alone = run(problem, candidate);
      for (const int threads : {2, 3, 0}) CHECK(run(problem, candidate, {.threads = threads}).counts == alone.counts);
    }
  }
}

TEST_SUITE("progress") {
  TEST_CASE("techniques without lists of rays report the share of their search, in rising order, on any threads") {
    std::vector<Ray> some = rays();
    for (Ray& ray : some) ray.length = 1;
    const Problem problem = make_problem(some, discs());
    for (const Technique technique : {Technique::octree, Technique::grid, Technique::bsp, Technique::bvh,
                                      Technique::ray_map, Technique::photon_map})
      for (const int threads : {1, 3}) {
        CAPTURE(name(technique));
        if (!record_of(technique).built) continue;
        std::vector<double> shares;
        (void)run(problem, {technique, record_of(technique).defaults},
                  {.threads = threads, .progress = [&](double share) { shares.push_back(share); }});
        REQUIRE(shares.size() >= 8);
        CHECK(shares.front() == 0);
        CHECK(std::is_sorted(shares.begin(), shares.end()));
        CHECK(shares[shares.size() - 2] > 0.8);
        CHECK(shares[shares.size() - 2] < 1);
        CHECK(shares.back() == 1);
      }
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("each ray is searched once, and hits reach the totals in ray order, on any number of threads") {
    const Problem problem = make_problem(rays(), discs());
    glm::dvec3 power{0};
    for (const Ray& ray : rays()) power[dominant_axis(ray.direction)] += ray.power;
    for (const int threads : {1, 2, 3}) {
      Totals totals;
      Outcome outcome;
      search_rays(
          problem, {.threads = threads, .totals = &totals},
          [] { return make_in<RaySearch, AllHit>(*std::pmr::new_delete_resource(), [] {}); }, outcome);
      CHECK(outcome.total_hits == rays().size());
      CHECK(totals[0].hits == rays().size());
      CHECK(totals[0].power == power);
      CHECK_FALSE(outcome.stopped);
    }
  }

  TEST_CASE("after a stop request it ends soon, and keeps the hits of all rays before some ray") {
    const Problem problem = make_problem(rays(), discs());
    for (const int threads : {1, 2}) {
      std::stop_source source;
      Outcome outcome;
      search_rays(
          problem, {.pairs = true, .stop = source.get_token(), .threads = threads},
          [&] { return make_in<RaySearch, AllHit>(*std::pmr::new_delete_resource(), [&] { source.request_stop(); }); },
          outcome);
      CHECK(outcome.stopped);
      CHECK(outcome.total_hits > 1000);
      CHECK(outcome.total_hits < 2000);
      CHECK(outcome.progress.done == outcome.total_hits);  // one hit for each ray
      CHECK(outcome.progress.of == rays().size());
      CHECK(outcome.pairs.empty());
    }
  }

  TEST_CASE("an exception of a search reaches the caller") {
    const Problem problem = make_problem(rays(), discs());
    for (const int threads : {1, 2}) {
      Outcome outcome;
      const auto search = [&] {
        search_rays(
            problem, {.threads = threads},
            [] {
              return make_in<RaySearch, AllHit>(*std::pmr::new_delete_resource(),
                                                [] { throw std::length_error("too large"); });
            },
            outcome);
      };
      CHECK_THROWS_WITH_AS(search(), "too large", std::length_error);
    }
  }

  TEST_CASE("work on N threads has N threads, even if there are fewer cores") {
    CHECK(thread_count(0) >= 1);
    for (const int threads : {1, 2, 3, 5}) {
      CHECK(thread_count(threads) == threads);
      int found = 0;
      on_threads(threads, [&] { found = oneapi::tbb::this_task_arena::max_concurrency(); });
      CHECK(found == threads);
    }
  }
}
