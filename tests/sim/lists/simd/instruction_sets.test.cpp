#include "detp/sim/lists/simd/instruction_sets.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "detp/sim/lists/simd/list_search.hpp"
#include "detp/sim/technique/technique.hpp"
#include "support/float_candidates.hpp"
#include "support/hard_scene.hpp"
#include "support/instruction_sets.hpp"

using namespace detp;
using namespace detp::sim;
using namespace detp::support;

namespace {

/// Lines and segments of the hard families, except those so far away that floats decide little. All are aimed at the
/// discs of one scene. Their powers are all 1, or span ten decades.
HardScene mixed_scene(bool equal_powers) {
  HardScene scene = hard_scene(0, 0, 60, 1);
  scene.rays.clear();
  for (const std::size_t family : {0, 1, 2, 7, 8}) {
    RandomSequence random(500 + family, equal_powers ? 0 : 1);
    for (std::size_t i = 0; i < 600; ++i) {
      scene.rays.push_back(hard_ray(families[family], random, scene.discs[i % scene.discs.size()]));
      if (!equal_powers) scene.rays.back().power = std::pow(10, 10 * random.uniform());
    }
  }
  return scene;
}

void check_same_bytes(const Problem& problem, const Outcome& expected) {
  for (const Candidate& candidate : float_candidates()) {
    CAPTURE(describe(candidate));
    CAPTURE(name(candidate.technique));
    for (const bool pairs : {true, false}) {
      const Outcome outcome = run(problem, candidate, {.pairs = pairs});
      CHECK(outcome.hits == expected.hits);
      CHECK(outcome.irradiance == expected.irradiance);
      if (pairs) CHECK(outcome.pairs == expected.pairs);
    }
  }
}

/// Runs every instruction set that the machine has.
void check_same_bytes_by_all(const Problem& problem) {
  const Outcome expected =
      run(problem, {Technique::brute_force, BruteForceParameters{}}, {.pairs = true, .engine = Engine::plain});
  CHECK(expected.total_hits > 500);
  with_each_instruction_set([&] { check_same_bytes(problem, expected); });
}

/// The names, such as "AVX2 AVX3", of the instruction sets that the machine has (or lacks).
std::string names(bool had) {
  std::string list;
  for (const stream::InstructionSet& set : stream::compiled_instruction_sets())
    if (set.here == had) list += fmt::format("{}{}", list.empty() ? "" : " ", set.name);
  return list;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("hits, irradiance and pairs are the same bytes with every instruction set and in doubles") {
    const std::string best = stream::instruction_set();
    MESSAGE("instruction sets tried: ", names(true));
    WARN_MESSAGE(names(false).empty(), "not tried, for this machine lacks them: ", names(false));
    for (const bool equal_powers : {true, false}) {
      const HardScene scene = mixed_scene(equal_powers);
      for (const bool front : {false, true}) check_same_bytes_by_all(make_problem(scene.rays, scene.discs, front));
    }
    CHECK(stream::instruction_set() == best);
  }

  TEST_CASE("an instruction set that the machine lacks is refused") {
    const auto use = [](const std::string& name) { const stream::OnlyInstructionSet only(name); };
    CHECK_THROWS_AS(use("AVX"), std::invalid_argument);
    for (const stream::InstructionSet& set : stream::compiled_instruction_sets())
      if (!set.here) CHECK_THROWS_AS(use(set.name), std::invalid_argument);
  }
}
