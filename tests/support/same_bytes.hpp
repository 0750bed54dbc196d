#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <span>
#include <vector>

#include "detp/sim/geometry/random.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"

/// Searches that must find the same bytes: any technique, engine and number of threads.
namespace detp::support {

/// Lines whose powers span ten decades, so that adding in another order gives another sum.
inline std::vector<sim::Ray> uneven_lines(std::span<const sim::Disc> discs, std::size_t count) {
  std::vector<sim::Ray> lines = sim::LineField(sim::enclosing_sphere(discs), 4).lines(0, count);
  for (std::size_t i = 0; i < count; ++i)
    lines[i].power = std::pow(10, 10 * sim::uniform4(5, sim::Stream::tests, i)[0]);
  return lines;
}

/// Decides every pair by the canonical predicate, in doubles.
inline sim::Outcome truth_of(const sim::Problem& problem) {
  return sim::run(problem, {Technique::brute_force, BruteForceParameters{}}, {.pairs = true, .engine = Engine::plain});
}

/// Compares what the options ask for: pairs, standard errors and bounds only if they are wanted.
inline void check_same(const sim::Outcome& found, const sim::Outcome& expected, const sim::RunOptions& options) {
  CHECK(found.total_hits == expected.total_hits);
  CHECK(found.hits == expected.hits);
  REQUIRE(found.bands() == expected.bands());
  for (std::size_t band = 0; band < found.bands(); ++band) {
    CAPTURE(band);
    const sim::BandResults& one = found.band(band);
    CHECK(one.irradiance == expected.band(band).irradiance);
    if (!options.standard_error) continue;
    CHECK(one.standard_error == expected.band(band).standard_error);
    CHECK(one.upper_bound == expected.band(band).upper_bound);
  }
  if (options.pairs)
    CHECK(found.pairs == expected.pairs);
  else
    CHECK(found.pairs.empty());
}

/// The ways to search that are compared: all combinations.
struct Ways {
  const std::vector<Candidate>& techniques;
  std::vector<Engine> engines = {Engine::simd};
  std::vector<int> threads = {1};
};

inline const std::vector<Engine> both_engines{Engine::simd, Engine::plain};

inline void check_same_by_all(const sim::Problem& problem, const sim::Outcome& expected, const Ways& ways,
                              sim::RunOptions options = {.pairs = true}) {
  for (const Candidate& candidate : ways.techniques)
    for (const Engine engine : ways.engines)
      for (const int threads : ways.threads) {
        INFO(name(candidate.technique), " ", describe(candidate), ", ", name(engine), ", threads ", threads);
        options.engine = engine;
        options.threads = threads;
        check_same(sim::run(problem, candidate, options), expected, options);
      }
}

}  // namespace detp::support
