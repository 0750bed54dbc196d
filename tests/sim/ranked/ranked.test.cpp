#include "detp/sim/ranked/ranked.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "../ranks/thread_ranks.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/sim/geometry/disc_source.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/photons/photon_source.hpp"
#include "detp/sim/ranked/ranked_rays.hpp"
#include "detp/sim/search/irradiance.hpp"
#include "detp/sim/technique/technique.hpp"
#include "support/attempts.hpp"
#include "support/discs_elsewhere.hpp"
#include "support/machine.hpp"
#include "support/same_bytes.hpp"

using namespace detp;
using namespace detp::sim;
using support::DiscsElsewhere;
using support::MemoryLimit;

namespace {

/// Lines with powers that tell the order of additions apart.
class UnequalLines final : public RaySource {
 public:
  /// Each read of 2¹⁵ lines sleeps for so many seconds.
  UnequalLines(const Sphere& sphere, std::uint64_t count, double seconds = 0)
      : lines_(sphere, 3, count), seconds_(seconds) {}
  [[nodiscard]] std::uint64_t size() const override { return lines_.size(); }
  void read(std::uint64_t first, std::span<Ray> block, const std::stop_token& stop) const override {
    lines_.read(first, block, stop);
    std::this_thread::sleep_for(
        std::chrono::duration<double>(seconds_ * static_cast<double>(block.size()) / (1 << 15)));
    made_ += block.size();
    for (std::size_t i = 0; i < block.size(); ++i)
      block[i].power = std::exp(20 * uniform4(5, Stream::tests, first + i)[0]);
  }
  [[nodiscard]] std::size_t bands() const override { return 3; }
  void read_all(std::uint64_t first, std::span<Ray> block, BesideRays& beside,
                const std::stop_token& stop) const override {
    read(first, block, stop);
    beside.further.clear();
    for (std::size_t i = 0; i < block.size(); ++i) {
      const auto random = uniform4(5, Stream::tests, first + i);
      beside.further.insert(beside.further.end(), {1e3 * random[1], std::exp(20 * random[2])});
    }
  }
  [[nodiscard]] double farthest_from(const glm::dvec3& point) const override { return lines_.farthest_from(point); }
  [[nodiscard]] std::uint64_t made() const { return made_; }

 private:
  LinesOfField lines_;
  double seconds_;
  mutable std::uint64_t made_ = 0;
};

void check_same_hits(const StreamedOutcome& found, const StreamedOutcome& expected) {
  support::check_same(found.outcome, expected.outcome,
                      {.pairs = !expected.outcome.pairs.empty(), .standard_error = true});
}

void check_same(const StreamedOutcome& found, const StreamedOutcome& expected) {
  check_same_hits(found, expected);
  CHECK(found.outcome.counts.loaded == expected.outcome.counts.loaded);
  CHECK(found.outcome.progress.done == expected.outcome.progress.done);
  CHECK(found.outcome.progress.of == expected.outcome.progress.of);
  CHECK_FALSE(found.outcome.stopped);
}

const std::vector<Candidate> techniques{{Technique::box_tree, BoxTreeParameters{}},
                                        {Technique::octree, OctreeParameters{3}},
                                        {Technique::sphere_cache, SphereCacheParameters{0.6, 4}},
                                        {Technique::grid, GridParameters{8}}};

/// Puts the results of discs that are not in memory where those of others are.
StreamedOutcome with_arrays(RankedOutcome ranked) {
  REQUIRE(ranked.results);
  Outcome& outcome = ranked.found.outcome;
  CHECK(outcome.hits.empty());
  CHECK(outcome.pairs.empty());
  ranked.results->for_each_disc([&](std::span<const DiscResult> by_band) {
    outcome.hits.push_back(by_band[0].hits);
    outcome.further.resize(by_band.size() - 1);
    for (std::size_t band = 0; band < by_band.size(); ++band) {
      outcome.band(band).irradiance.push_back(by_band[band].irradiance);
      if (!ranked.results->errors()) continue;
      outcome.band(band).standard_error.push_back(by_band[band].standard_error);
      outcome.band(band).upper_bound.push_back(by_band[band].upper_bound);
    }
  });
  ranked.results->for_each_pair([&](const Pair& pair) { outcome.pairs.push_back(pair); });
  return std::move(ranked.found);
}

/// What so many ranks find together; `search` is what each does.
template <class Search>
StreamedOutcome found_by(int count, const Search& search) {
  StreamedOutcome found;
  const auto thrown = on_ranks(count, [&](Ranks& ranks) {
    RankedOutcome own = search(ranks);
    if (ranks.rank() == 0) found = own.results ? with_arrays(std::move(own)) : std::move(own.found);
  });
  for (const std::exception_ptr& one : thrown) CHECK_FALSE(one);
  return found;
}

StreamOptions options_of(bool pairs) {
  return {.run = {.pairs = pairs, .standard_error = true}, .block = std::size_t{1} << 17};
}

}  // namespace

TEST_SUITE("ranks") {
  TEST_CASE("any number of ranks finds the bytes of one process: lines, four techniques" *
            doctest::test_suite("long")) {
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 20, 0.1, 3);
    const UnequalLines lines(enclosing_sphere(discs), 1'700'000);  // 52 blocks of photons
    for (std::size_t i = 0; i < techniques.size(); ++i) {
      CAPTURE(describe(techniques[i]));
      const StreamedOutcome expected = run_streamed(discs, lines, techniques[i], options_of(true));
      for (const int count : i == 0 ? std::vector{1, 2, 3, 4, 7, 9} : std::vector{static_cast<int>(i) + 1}) {
        CAPTURE(count);
        const StreamedOutcome found = found_by(
            count, [&](Ranks& ranks) { return run_on_ranks(discs, lines, techniques[i], options_of(true), ranks); });
        check_same(found, expected);
      }
    }
  }

  TEST_CASE("any number of ranks finds the bytes of one process: photon paths" * doctest::test_suite("long")) {
    const Scene scene = open_scene({"@cornell", 200, 1, {}, {}});
    std::vector<Disc> discs;
    for (const Sample& sample : scene.samples) discs.push_back({sample.position, sample.normal, 0.05});
    const PhotonSource paths(scene, 1'500'000, 1);
    CHECK(paths.first_ray_of(0) == 0);
    CHECK(paths.first_ray_of(paths.photons()) == paths.size());
    const StreamedOutcome expected = run_streamed(discs, paths, techniques[0], options_of(false));
    for (const int count : {2, 3}) {
      const StreamedOutcome found = found_by(count, [&](Ranks& ranks) {
        const PhotonSource together(scene, 1'500'000, 1, caster_for(scene), {}, &ranks);
        CHECK(together.size() == paths.size());
        CHECK(together.photons() == paths.photons());
        CHECK(together.farthest_from({0, 0, 0}) == paths.farthest_from({0, 0, 0}));
        RankedOutcome own = run_on_ranks(discs, together, techniques[0], options_of(false), ranks);
        return own;
      });
      check_same(found, expected);
    }
  }

  TEST_CASE("ranks that share the discs find the bytes of one process: four techniques, lines and photon paths" *
            doctest::test_suite("long")) {
    std::vector<Disc> discs = uniform_discs(Body::cube, 2, 60, 0.1, 3);
    for (std::size_t i = 0; i < discs.size(); i += 3) discs[i].radius = 0.02;
    const UnequalLines lines(enclosing_sphere(discs), 300'000);
    for (std::size_t i = 0; i < techniques.size(); ++i) {
      CAPTURE(describe(techniques[i]));
      const StreamedOutcome expected = run_streamed(discs, lines, techniques[i], options_of(true));
      for (const int count : i == 0 ? std::vector{1, 2, 3, 4, 7, 60} : std::vector{static_cast<int>(i) + 1}) {
        CAPTURE(count);
        const StreamedOutcome found = found_by(count, [&](Ranks& ranks) {
          return run_on_ranks(discs, lines, techniques[i], options_of(true), ranks, Share::discs);
        });
        check_same_hits(found, expected);
      }
      check_same_hits(run_in_parts(DiscsInMemory(discs), lines, techniques[i], options_of(true), 3).found, expected);
    }
    const Scene scene = open_scene({"@cornell", 200, 1, {}, {}});
    discs.clear();
    for (const Sample& sample : scene.samples) discs.push_back({sample.position, sample.normal, 0.05});
    const PhotonSource paths(scene, 200'000, 1);
    const StreamedOutcome expected = run_streamed(discs, paths, techniques[0], options_of(true));
    const StreamedOutcome found = found_by(3, [&](Ranks& ranks) {
      return run_on_ranks(discs, paths, techniques[0], options_of(true), ranks, Share::discs);
    });
    check_same_hits(found, expected);
    const auto refused = on_ranks(201, [&](Ranks& ranks) {
      static_cast<void>(run_on_ranks(discs, paths, techniques[0], options_of(true), ranks, Share::discs));
    });
    CHECK_THROWS_AS(std::rethrow_exception(refused[0]), std::invalid_argument);
  }

  TEST_CASE("discs that are not in memory are searched in parts, on any number of ranks, with the same bytes" *
            doctest::test_suite("long")) {
    std::vector<Disc> discs = uniform_discs(Body::cube, 2, 30'000, 0.02, 3);
    for (std::size_t i = 0; i < discs.size(); i += 3) discs[i].radius = 0.04;
    const DiscsElsewhere elsewhere(discs);
    const UnequalLines lines(enclosing_sphere(discs), 100'000);
    StreamOptions options = options_of(true);
    options.block = std::size_t{1} << 14;
    for (const Candidate& candidate : techniques) {
      CAPTURE(describe(candidate));
      const StreamedOutcome expected = run_streamed(discs, lines, candidate, options);
      check_same_hits(with_arrays(run_in_parts(elsewhere, lines, candidate, options, 5)), expected);
      for (const int count : {1, 2, 3}) {
        const MemoryLimit limit(36.0 * (1 << 20));
        const StreamedOutcome found = found_by(count, [&](Ranks& ranks) {
          RankedOutcome own = run_on_ranks(elsewhere, lines, candidate, options, ranks);
          CHECK(own.found.bytes < 36.0 * (1 << 20));
          CHECK((own.results != nullptr) == (ranks.rank() == 0));
          return own;
        });
        check_same_hits(found, expected);
      }
    }
  }

  TEST_CASE("discs in memory whose index does not fit are searched in parts, with standard errors") {
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 100'000, 0.01, 3);
    const UnequalLines lines(enclosing_sphere(discs), 50'000);
    StreamOptions options = options_of(false);
    options.block = std::size_t{1} << 14;
    const StreamedOutcome expected = run_streamed(discs, lines, techniques[0], options);
    OneRank one;
    const MemoryLimit limit(40.0 * (1 << 20));
    CHECK_THROWS_AS(static_cast<void>(run_streamed(discs, lines, techniques[0], options)), std::length_error);
    check_same_hits(run_on_ranks(discs, lines, techniques[0], options, one).found, expected);
    const MemoryLimit too_small(20.0 * (1 << 20));
    CHECK_THROWS_AS(static_cast<void>(run_on_ranks(discs, lines, techniques[0], options, one)), std::length_error);
  }

  TEST_CASE("discs that are shared anew, because no ray meets half of them, find the same bytes" *
            doctest::test_suite("long")) {
    std::vector<Disc> discs = uniform_discs(Body::cube, 2, 4000, 0.05, 3);
    const UnequalLines lines(enclosing_sphere(discs), 2'200'000);
    const std::vector<Disc> near = discs;
    for (const Disc& disc : near) discs.push_back({disc.centre + glm::dvec3{10, 0, 0}, disc.normal, disc.radius});
    const StreamedOutcome expected = run_streamed(discs, lines, techniques[0], options_of(false));
    const StreamedOutcome found = found_by(2, [&](Ranks& ranks) {
      return run_on_ranks(discs, lines, techniques[0], options_of(false), ranks, Share::discs);
    });
    check_same_hits(found, expected);
  }

  TEST_CASE("parts are whole blocks of photons, follow one another, and are as equal as can be") {
    const LinesOfField lines({{0, 0, 0}, 1}, 1, 5 * (std::uint64_t{1} << 18) + 7);
    const PhotonBlocks blocks{18};
    const CutOfRays cut(lines, blocks, 4);
    REQUIRE(cut.parts().size() == 4);
    CHECK_FALSE(cut.has_rest());
    std::uint64_t first = 0;
    for (const auto& ranges : cut.parts()) {
      REQUIRE(ranges.size() == 1);
      CHECK(ranges[0].first == first);
      CHECK(ranges[0].first == std::min(lines.size(), blocks.first(ranges[0].block)));
      CHECK(ranges[0].last - ranges[0].first <= 2U << 18);
      first = ranges[0].last;
    }
    CHECK(first == lines.size());
    CHECK(CutOfRays(LinesOfField({{0, 0, 0}, 1}, 1, 10), blocks, 3).parts()[2][0].first == 10);
  }

  TEST_CASE("ranks whose heads took longer get less of the rest; every block is in one part") {
    const LinesOfField lines({{0, 0, 0}, 1}, 1, 300 * (std::uint64_t{1} << 10) + 7);
    const PhotonBlocks blocks{10};
    for (const std::vector<double>& seconds :
         {std::vector{1.0, 1.1, 1.0}, {1.0, 2.0, 1.0}, {5.0, 1.0, 1.0}, {1.0, 1.0, 40.0}, {0.001, 0.002, 0.001}}) {
      INFO("seconds[0] ", seconds[0], ", seconds[1] ", seconds[1]);
      CutOfRays cut(lines, blocks, 3);
      REQUIRE(cut.has_rest());
      for (int rank = 0; rank < 3; ++rank) CHECK(cut.heads()[rank].next_block - cut.heads()[rank].block == 12);
      cut.correct(seconds);
      std::vector<int> met(301);
      std::vector<double> rays(3);
      for (std::size_t rank = 0; rank < 3; ++rank)
        for (const ShareOfRays& range : cut.parts()[rank]) {
          CHECK(range.first == std::min(lines.size(), blocks.first(range.block)));
          CHECK(range.last == std::min(lines.size(), blocks.first(range.next_block)));
          for (std::uint64_t block = range.block; block < range.next_block; ++block) ++met[block];
          rays[rank] += static_cast<double>(range.last - range.first);
        }
      for (const int count : met) CHECK(count == 1);
      const bool equal = seconds[1] == 1.1 || seconds[0] < 0.01;
      const double head = 12 << 10;
      const double rest = static_cast<double>(lines.size()) - 3 * head;
      const double speeds = 1 / seconds[0] + 1 / seconds[1] + 1 / seconds[2];
      for (std::size_t rank = 0; rank < 3; ++rank) {
        const double expected = equal ? (rest + 3 * head) / 3 : head + rest / seconds[rank] / speeds;
        CHECK(std::abs(rays[rank] - expected) <= 2 << 10);
      }
    }
  }

  TEST_CASE("ranks of unequal speed find the bytes of one process, and the slow one has less to do" *
            doctest::test_suite("long")) {
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 20, 0.1, 3);
    const Sphere sphere = enclosing_sphere(discs);
    constexpr std::uint64_t count = 64 << 15;
    const StreamedOutcome expected = run_streamed(discs, UnequalLines(sphere, count), techniques[0], options_of(true));
    for (const int slow : {0, 1, 2}) {
      CAPTURE(slow);
      double seconds = 0.02;
      CHECK(support::in_attempts(5, [&] {  // on a busy machine the others may seem slow, too
        std::vector<std::uint64_t> loaded(3);
        const StreamedOutcome found = found_by(3, [&](Ranks& ranks) {
          const UnequalLines lines(sphere, count, ranks.rank() == slow ? 7.5 * seconds : seconds);
          RankedOutcome own = run_on_ranks(discs, lines, techniques[0], options_of(true), ranks);
          loaded[static_cast<std::size_t>(ranks.rank())] = lines.made();
          return own;
        });
        check_same(found, expected);
        seconds *= 2;
        const std::uint64_t of_slow = std::exchange(loaded[static_cast<std::size_t>(slow)], count);
        return static_cast<double>(of_slow) < 0.6 * static_cast<double>(std::ranges::min(loaded));
      }));
    }
  }

  TEST_CASE("sums of parts that do not follow one another are refused") {
    Totals first(3);
    Totals second(3);
    second.begin_at(2);
    CHECK_THROWS_AS(first.append(second), std::invalid_argument);
    first.complete(2);
    CHECK_NOTHROW(first.append(second));
    CHECK_THROWS_AS(first.append(Totals(4)), std::invalid_argument);
  }
}
