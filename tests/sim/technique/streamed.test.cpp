#include "detp/sim/technique/streamed.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/photons/photon_source.hpp"
#include "support/candidates.hpp"
#include "support/machine.hpp"
#include "support/same_bytes.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

const std::vector<Disc>& streamed_discs() {
  static const std::vector<Disc> all = uniform_discs(Body::cube, 2, 80, 0.6, 3);
  return all;
}

/// Lines and segments whose powers span ten decades, so that adding in another order gives another sum.
const std::vector<Ray>& streamed_rays() {
  static const std::vector<Ray> all = [] {
    std::vector<Ray> some = LineField(enclosing_sphere(streamed_discs()), 4).lines(0, 400);
    for (std::size_t i = 0; i < some.size(); ++i) {
      const auto random = uniform4(5, Stream::tests, i);
      some[i].power = std::pow(10, 10 * random[0]);
      if (i % 3 == 0) some[i].length = 0.1 + 2 * random[1];
    }
    return some;
  }();
  return all;
}

const std::vector<Candidate>& streamed_candidates = support::one_of_each();

/// A source whose farthest_from returns less than the distance at which its rays start.
class UnderstatedDistance final : public RaySource {
 public:
  std::uint64_t size() const override { return streamed_rays().size(); }
  void read(std::uint64_t first, std::span<Ray> block, const std::stop_token&) const override {
    RaysInMemory(streamed_rays()).read(first, block);
  }
  double farthest_from(const glm::dvec3& point) const override {
    return 0.9 * RaysInMemory(streamed_rays()).farthest_from(point);
  }
};

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("a stream in blocks of 1, 7 and 1000 rays gives the bytes of one run over rays in memory") {
    for (const bool front : {false, true}) {
      const Problem problem = make_problem(streamed_rays(), streamed_discs(), front);
      const Outcome expected = support::truth_of(problem);
      CHECK(expected.total_hits > 250);
      for (const Candidate& candidate : streamed_candidates) {
        CAPTURE(name(candidate.technique));
        const Outcome whole = run(problem, candidate, {.pairs = true});
        for (const std::size_t block : {1, 7, 1000}) {
          CAPTURE(block);
          const StreamedOutcome streamed = run_streamed(
              streamed_discs(), RaysInMemory(streamed_rays()), candidate,
              {.run = {.pairs = true, .threads = block == 7 ? 2 : 1}, .front_facing = front, .block = block});
          support::check_same(streamed.outcome, expected, {.pairs = true});
          CHECK(streamed.outcome.counts.hits == expected.total_hits);
          if (candidate.technique != Technique::ray_map)  // makes a map of each block
            CHECK(streamed.outcome.counts.disc_tests == whole.counts.disc_tests);
        }
      }
    }
  }

  TEST_CASE("sums of many discs over blocks of photons are the same on any threads and by both engines" *
            doctest::test_suite("long")) {
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 20'000, 0.02, 3);
    REQUIRE(discs.size() > 1U << 14);  // a thread has at least so many
    const std::uint64_t count = 1'100'000;
    REQUIRE(count > 2 * PhotonBlocks::for_discs(discs.size()).first(1));
    const std::vector<Ray> rays = support::uneven_lines(discs, count);
    const std::vector<Ray> equal = LineField(enclosing_sphere(discs), 4).lines(0, count);
    for (const auto& some : {rays, equal}) {
      StreamOptions options{.run = {.engine = Engine::plain}, .block = 300'000};
      options.run.standard_error = true;
      const Candidate by_ray{Technique::octree, OctreeParameters{4}};
      const Outcome plain = run_streamed(discs, RaysInMemory(some), by_ray, options).outcome;
      options.run.engine = Engine::simd;
      for (const int threads : {1, 2, 5}) {
        options.run.threads = threads;
        const Candidate by_lists{Technique::box_tree, BoxTreeParameters{8, 8}};
        const Outcome found = run_streamed(discs, RaysInMemory(some), by_lists, options).outcome;
        support::check_same(found, plain, options.run);
      }
    }
  }

  TEST_CASE("an index is built once, and its build counts do not depend on the block size") {
    for (const Candidate& candidate : {Candidate{Technique::octree, OctreeParameters{2}},
                                       {Technique::grid, GridParameters{6}},
                                       {Technique::bsp, BspParameters{8, 4}}}) {
      const Outcome whole = run(make_problem(streamed_rays(), streamed_discs()), candidate);
      const StreamedOutcome streamed =
          run_streamed(streamed_discs(), RaysInMemory(streamed_rays()), candidate, {.run = {}, .block = 100});
      CHECK(streamed.outcome.counts == whole.counts);
      CHECK(whole.counts.references > 0);
    }
  }

  TEST_CASE("lines of a field by number equal those in memory") {
    const Sphere sphere = enclosing_sphere(streamed_discs());
    const std::vector<Ray> lines = LineField(sphere, 9).lines(0, 3000);
    const Outcome whole = run(make_problem(lines, streamed_discs()), streamed_candidates.back());
    const StreamedOutcome streamed = run_streamed(streamed_discs(), LinesOfField(sphere, 9, lines.size()),
                                                  streamed_candidates.back(), {.run = {}, .block = 512});
    CHECK(streamed.outcome.irradiance == whole.irradiance);
    CHECK(streamed.block == 512);
  }

  TEST_CASE("photon paths that are traced as they are searched bring what they bring in memory") {
    Scene scene = open_scene({.name = "@cornell", .samples = {}});
    std::vector<Disc> discs;
    for (const Sample& sample : scene.samples) discs.push_back({sample.position, sample.normal, 0.02});
    for (const std::size_t count : {3000, 200'000}) {
      const TracedPaths paths = photon_paths(scene, count, 3);
      const RunOptions options{.standard_error = true, .threads = 2};
      const Candidate tree{Technique::box_tree, BoxTreeParameters{}};
      const Outcome all = run(make_problem(paths, discs), tree, options);
      for (const Counting counting : {Counting::ahead, Counting::as_read}) {
        const PhotonSource source(scene, count, 3, caster_for(scene), {}, nullptr, counting);
        const StreamedOutcome streamed = run_streamed(discs, source, tree, {.run = options, .block = 30'000});
        const Outcome& found = streamed.outcome;
        CHECK(found.hits == all.hits);
        CHECK(found.progress.done == paths.rays.size());
        CHECK(found.progress.of == paths.rays.size());
        for (std::size_t disc = 0; disc < discs.size(); ++disc) {
          REQUIRE(found.irradiance[disc] == doctest::Approx(all.irradiance[disc]).epsilon(1e-12));
          REQUIRE(found.upper_bound[disc] == doctest::Approx(all.upper_bound[disc]).epsilon(1e-9));
          if (std::isfinite(all.standard_error[disc]))
            REQUIRE(found.standard_error[disc] == doctest::Approx(all.standard_error[disc]).epsilon(1e-9));
        }
      }
    }
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("a stop between blocks keeps the blocks before it, and is reported") {
    std::stop_source source;
    int blocks = 0;
    const auto stop_before_third = [&](double done) {
      CHECK(done == blocks * 100 / 400.0);
      if (++blocks == 3) source.request_stop();
    };
    const StreamedOutcome streamed =
        run_streamed(streamed_discs(), RaysInMemory(streamed_rays()), streamed_candidates.back(),
                     {.run = {.stop = source.get_token()}, .block = 100, .progress = stop_before_third});
    const Outcome half =
        run(make_problem(std::span(streamed_rays()).first(200), streamed_discs()), streamed_candidates.back());
    CHECK(streamed.outcome.stopped);
    CHECK(streamed.outcome.hits == half.hits);
    CHECK(streamed.outcome.total_hits == half.total_hits);
  }

  TEST_CASE("a stream has more than four rays for each disc, at least 2^20, at most 2^24") {
    CHECK(default_block(1) == 1U << 20);
    CHECK(default_block(1U << 19) == 1U << 21);
    CHECK(default_block(3'000'000) == 1U << 24);
    CHECK(default_block(100'000'000) == 1U << 24);
  }

  TEST_CASE("a stream has 2^18 rays in memory, more with many discs, fewer with little memory") {
    CHECK(block_in_memory(1) == 1U << 18);
    CHECK(block_in_memory(1U << 19) == 1U << 21);
    const support::MemoryLimit limit(64.0 * (1 << 20));
    CHECK(block_in_memory(1) == 1U << 17);
    CHECK(block_in_memory(1U << 19) == 1U << 17);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("an index that would not fit in memory is refused before allocation, naming the bytes") {
    const LinesOfField lines(enclosing_sphere(streamed_discs()), 1, 1'000'000'000'000);
    const auto stream = [&](const RaySource& source, const StreamOptions& options) {
      static_cast<void>(run_streamed(streamed_discs(), source, streamed_candidates.front(), options));
    };
    CHECK_THROWS_WITH_AS(stream(lines, {.run = {}, .block = 1'000'000'000'000}), doctest::Contains("6.4e+04 GB"),
                         std::length_error);
    CHECK_THROWS_WITH_AS(stream(lines, {.run = {.pairs = true}}), doctest::Contains("too many for pairs"),
                         std::length_error);
  }

  TEST_CASE("no rays, no discs, invalid rays, rays that start too far away, and totals of other discs are refused") {
    const auto stream = [](std::span<const Disc> some, const RaySource& source, const RunOptions& options) {
      static_cast<void>(run_streamed(some, source, streamed_candidates.back(), {.run = options, .block = 100}));
    };
    CHECK_THROWS_WITH_AS(stream(streamed_discs(), RaysInMemory({}), {}), doctest::Contains("at least one ray"),
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS(stream({}, RaysInMemory(streamed_rays()), {}), doctest::Contains("at least one disc"),
                         std::invalid_argument);
    std::vector<Ray> bad = streamed_rays();
    bad[250].power = -1;
    CHECK_THROWS_WITH_AS(stream(streamed_discs(), RaysInMemory(bad), {}),
                         doctest::Contains("ray 250: power must be >= 0 and finite (got -1)"), std::invalid_argument);
    CHECK_THROWS_WITH_AS(stream(streamed_discs(), UnderstatedDistance(), {}), doctest::Contains("a ray starts"),
                         std::invalid_argument);
    Totals totals(streamed_discs().size() + 1);
    CHECK_THROWS_WITH_AS(stream(streamed_discs(), RaysInMemory(streamed_rays()), {.totals = &totals}),
                         doctest::Contains("totals"), std::invalid_argument);
    const Candidate candidate{Technique::box_tree, BoxTreeParameters{}};
    for (const auto& [first, last] : {std::pair{5, 5}, {0, 1'000'000}})
      CHECK_THROWS_AS((void)run_streamed(streamed_discs(), RaysInMemory(streamed_rays()), candidate,
                                         {.run = {}, .first = static_cast<std::uint64_t>(first), .last = last}),
                      std::invalid_argument);
  }
}
