// Compares all exact techniques (in floats and in doubles, in one run and in blocks) with the predicate: they must find
// the same pairs, and the same bits of irradiance.

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <vector>

#include "detp/sim/technique/streamed.hpp"
#include "problem_from_bytes.hpp"

namespace {

using namespace detp;
using namespace detp::sim;

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  });
}

[[noreturn]] void report(const fuzz::SmallProblem& small, const Candidate& candidate, const char* how) {
  fmt::print(stderr, "differs from the predicate: {} {} {}\n", name(candidate.technique), describe(candidate), how);
  for (const Disc& d : small.discs)
    fmt::print(stderr, "disc {} {} {}  {} {} {}  {}\n", d.centre.x, d.centre.y, d.centre.z, d.normal.x, d.normal.y,
               d.normal.z, d.radius);
  for (const Ray& r : small.rays)
    fmt::print(stderr, "ray {} {} {}  {} {} {}  {}  {}\n", r.origin.x, r.origin.y, r.origin.z, r.direction.x,
               r.direction.y, r.direction.z, r.length, r.power);
  std::abort();
}

void compare(const fuzz::SmallProblem& small, const Candidate& candidate, const char* how, const Outcome& outcome,
             const Outcome& truth) {
  const bool same = outcome.pairs == truth.pairs && outcome.hits == truth.hits &&
                    outcome.total_hits == truth.total_hits && same_bits(outcome.irradiance, truth.irradiance);
  if (!same) report(small, candidate, how);
}

/// A small parameter value, selected by the bytes.
ParameterValue value_of(const Parameter& parameter, FuzzedDataProvider& bytes) {
  if (!parameter.choices.empty())
    return parameter.choices[bytes.ConsumeIntegralInRange<std::size_t>(0, parameter.choices.size() - 1)];
  if (std::holds_alternative<double>(parameter.small)) return (bytes.ConsumeIntegralInRange(0, 63) + 0.5) / 64;
  const auto least = static_cast<std::int64_t>(parameter.least);
  return bytes.ConsumeIntegralInRange<std::int64_t>(least, least + std::get<std::int64_t>(parameter.small));
}

/// Every exact technique, with parameters selected by the bytes. For so few discs Embree takes a hundred times as long
/// as the other techniques, so it runs in only one problem of eight.
std::vector<Candidate> candidates(FuzzedDataProvider& bytes) {
  std::vector<Candidate> list;
  for (const TechniqueRecord& record : technique_records) {
    if (!record.exact) continue;
    if (record.technique == Technique::bvh && bytes.ConsumeIntegralInRange(0, 7) != 0) continue;
    Candidate candidate = default_candidate(record.technique);
    for (const Parameter& parameter : record.parameters)
      set_parameter(candidate, parameter.name, value_of(parameter, bytes));
    list.push_back(candidate);
  }
  return list;
}

void compare_streamed(const fuzz::SmallProblem& small, const Candidate& candidate, std::size_t block,
                      const Outcome& truth) {
  const StreamOptions options{.run = {.pairs = true}, .front_facing = small.front_facing, .block = block};
  const Outcome outcome = run_streamed(small.discs, RaysInMemory(small.rays), candidate, options).outcome;
  compare(small, candidate, "in blocks", outcome, truth);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider bytes(data, size);
  const fuzz::SmallProblem small = fuzz::ProblemMaker(bytes).make();
  std::optional<Problem> made;
  try {
    made = make_problem(small.rays, small.discs, small.front_facing);
  } catch (const std::invalid_argument&) {
    return -1;  // coordinates too large, or sizes too small
  }
  const Problem& problem = *made;
  const Candidate brute{Technique::brute_force, BruteForceParameters{}};
  const Outcome truth = run(problem, brute, {.pairs = true, .engine = Engine::plain});
  for (const double irradiance : truth.irradiance)
    if (!std::isfinite(irradiance)) report(small, brute, "irradiance is not finite");
  const std::vector<Candidate> list = candidates(bytes);
  const bool count = bytes.ConsumeBool();
  const bool pairs = bytes.ConsumeBool();  // without pairs, a search may count hits and add up the powers at the end
  const int threads = bytes.ConsumeIntegralInRange(0, 63) == 0 ? 2 : 1;
  const Candidate& in_blocks = list[bytes.ConsumeIntegralInRange<std::size_t>(0, 4 * list.size()) % list.size()];
  compare_streamed(small, in_blocks, bytes.ConsumeIntegralInRange<std::size_t>(1, 5), truth);
  for (const Candidate& candidate : list)
    for (const bool plain : {false, true})
      if (!plain || record_of(candidate.technique).simd) {
        Outcome outcome =
            run(problem, candidate,
                {.count = count, .pairs = pairs, .engine = plain ? Engine::plain : Engine::simd, .threads = threads});
        if (!pairs) outcome.pairs = truth.pairs;
        compare(small, candidate, plain ? "plain" : "simd", outcome, truth);
      }
  return 0;
}
