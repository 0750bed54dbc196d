#include "fastest_of.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "detp/validate/base/own_time.hpp"
#include "detp/validate/base/stop_after.hpp"
#include "detp/validate/choice/neighbours.hpp"

namespace detp::zones {
namespace {

constexpr double least_limit = 0.02;  ///< seconds
constexpr double patience = 3;        ///< a neighbour is abandoned after so many times the seconds of the fastest
constexpr double short_run = 0.05;    ///< seconds; shorter runs are timed three times
constexpr double enough = 0.99;       ///< a neighbour must take less than this share of the fastest, to replace it
constexpr int most_steps = 12;

std::optional<FirstRuns> first_runs(const sim::Problem& problem, const Candidate& candidate, Engine engine,
                                    double limit) {
  try {
    FirstRuns runs{candidate, limit, true};
    const int repeats = 3;
    for (int i = 0; i < repeats; ++i) {
      const auto seconds = time_of(problem, candidate, engine, limit);
      if (!seconds) return runs;
      runs.seconds = i == 0 ? *seconds : std::min(runs.seconds, *seconds);
      runs.abandoned = false;
      if (*seconds > short_run) break;
    }
    return runs;
  } catch (const std::length_error&) {  // its index does not fit in memory
    return std::nullopt;
  }
}

}  // namespace

std::optional<double> time_of(const sim::Problem& problem, const Candidate& candidate, Engine engine, double limit) {
  const validate::StopAfter clock({}, limit);
  const validate::OwnTime time(1);
  const sim::Outcome outcome = sim::run(problem, candidate, {.count = false, .engine = engine, .stop = clock.token()});
  if (outcome.stopped) return std::nullopt;
  return time.own_part_of(outcome.seconds.total());
}

std::optional<FirstRuns> fastest_of(const sim::Problem& problem, const Candidate& first, Engine engine,
                                    const TimeLimits& limits) {
  std::optional<FirstRuns> fastest = first_runs(problem, first, engine, std::max(limits.first, least_limit));
  if (!fastest || fastest->abandoned || fastest->seconds > limits.tuned) return fastest;
  std::vector<Candidate> tried{first};
  for (int step = 0; step < most_steps; ++step) {
    const FirstRuns before = *fastest;
    for (const Candidate& next : validate::neighbours(before.candidate)) {
      if (std::find(tried.begin(), tried.end(), next) != tried.end()) continue;
      tried.push_back(next);
      const auto runs = first_runs(problem, next, engine, std::max(least_limit, patience * fastest->seconds));
      if (runs && !runs->abandoned && runs->seconds < enough * fastest->seconds) *fastest = *runs;
    }
    if (fastest->candidate == before.candidate) break;
  }
  return fastest;
}

}  // namespace detp::zones
