#include "bench.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/validate/choice/pilot.hpp"
#include "detp/validate/measure/rounds.hpp"
#include "detp/validate/statistics/statistics.hpp"

namespace detp::validate {
namespace {

constexpr int least_rounds = 3;
constexpr std::size_t finalists_of_a_side = 2;

class RaceRunner {
 public:
  RaceRunner(const Job& job, const RightHits& right, const EmbreePeer* embree, const RaceOptions& options)
      : job_(job), right_(right), embree_(embree), options_(options) {}

  Race run_all(const std::vector<Competitor>& competitors) {
    for (const Competitor& competitor : competitors) race_.results.push_back({competitor});
    TimesOfAll times = timed_rounds(
        competitors.size(),
        {.rounds = options_.repeats,
         .rounds_of_all = 1,
         .least_rounds = least_rounds,
         .most_seconds = options_.most_seconds},
        [&](const TimesOfAll& so_far) { return finalists(so_far); },
        [&](std::size_t i, std::span<const double> so_far) {
          report(race_.results[i].competitor, so_far);
          return run(race_.results[i]);
        });
    for (std::size_t i = 0; i < times.size(); ++i) race_.results[i].seconds = std::move(times[i]);
    std::erase_if(race_.results, [](const CompetitorResult& result) { return result.seconds.empty(); });
    race_.complete = race_.results.size() == competitors.size();
    return std::move(race_);
  }

 private:
  /// Reports the next run. In the first round it is expected to take as long as the mean of the runs before it, later
  /// as long as the competitor's first run.
  void report(const Competitor& next, std::span<const double> times) {
    if (!options_.progress) return;
    constexpr double first_round = 0.8;  // expected share of the time of the race
    const double step = times.empty()
                            ? first_round / static_cast<double>(race_.results.size())
                            : (1 - first_round) / (2.0 * finalists_of_a_side * std::max(1, options_.repeats - 1));
    const double before = std::exchange(share_, std::min(1.0, share_ + step));
    options_.progress({technique_of(next), before, share_, 0,
                       times.empty() ? watch_.seconds() / std::max(1.0, before / step) : times.front()});
  }

  /// The seconds of a run; nullopt if a stop request ended it.
  std::optional<double> run(CompetitorResult& result) const {
    const OwnTime time(options_.threads);
    if (const auto* mode = std::get_if<EmbreeMode>(&result.competitor)) {
      const PeerOutcome outcome = embree_->run(job_.rays, job_.discs, *mode, options_.stop);
      return record_run(result, outcome, time.seconds());
    }
    // Checked for each run: its time is that of a program that has rays and discs.
    const sim::Problem problem =
        sim::make_problem(job_.paths(), job_.discs, job_.front_facing, options_.threads, options_.stop);
    sim::RunOptions how{.count = false, .stop = options_.stop, .threads = options_.threads};
    if (const auto* candidate = std::get_if<Candidate>(&result.competitor)) {
      const sim::Outcome outcome = sim::run(problem, *candidate, how);
      return record_run(result, outcome, time.seconds());
    }
    try {
      Choice choice = choose(
          {.problem = &problem, .purpose = Purpose::one_search, .threads = options_.threads, .stop = options_.stop},
          options_.costs.value());
      how.threads = choice.best().threads;
      const sim::Outcome outcome = sim::run(problem, *build_choice(choice, problem, how), how);
      return record_run(result, outcome, time.seconds());
    } catch (const sim::Stopped&) {
      return std::nullopt;
    }
  }

  template <class Outcome>
  std::optional<double> record_run(CompetitorResult& result, const Outcome& outcome, double seconds) const {
    if (outcome.stopped) return std::nullopt;
    result.hits = std::accumulate(outcome.hits.begin(), outcome.hits.end(), std::uint64_t{0});
    result.wrong_hits = std::max(result.wrong_hits, right_.wrong_hits(outcome.hits));
    return seconds;
  }

  /// Those of each side that were the fastest in the first round, and our choice.
  [[nodiscard]] std::vector<bool> finalists(const TimesOfAll& times) const {
    std::vector<bool> chosen(times.size());
    std::vector<std::size_t> ours;
    std::vector<std::size_t> embree;
    for (std::size_t i = 0; i < times.size(); ++i) {
      const Competitor& competitor = race_.results[i].competitor;
      if (std::holds_alternative<OwnChoice>(competitor))
        chosen[i] = true;
      else
        (is_embree(competitor) ? embree : ours).push_back(i);
    }
    for (std::vector<std::size_t>* side : {&ours, &embree}) {
      std::ranges::stable_sort(*side, {}, [&](std::size_t i) { return times[i].front(); });
      side->resize(std::min(side->size(), finalists_of_a_side));
      for (const std::size_t i : *side) chosen[i] = true;
    }
    return chosen;
  }

  const Job& job_;
  const RightHits& right_;
  const EmbreePeer* embree_;
  const RaceOptions& options_;
  sim::Stopwatch watch_;
  double share_ = 0;  ///< share of the time that is done after the current run
  Race race_;
};

}  // namespace

std::uint64_t RightHits::wrong_hits(std::span<const std::uint64_t> others) const {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) sum += hits[i] > others[i] ? hits[i] - others[i] : others[i] - hits[i];
  return sum;
}

RightHits right_hits(const Job& job, const Candidate& exact, double checkable, const std::stop_token& stop) {
  const double pairs = static_cast<double>(job.rays.size()) * static_cast<double>(job.discs.size());
  const Candidate judge = pairs <= checkable ? Candidate{Technique::brute_force, BruteForceParameters{}} : exact;
  sim::Outcome outcome = sim::run(job.problem(), judge, {.count = false, .stop = stop, .threads = 0});
  if (outcome.stopped) throw sim::Stopped("stopped while the right hits were searched");
  return {judge.technique, std::move(outcome.hits)};
}

std::string technique_of(const Competitor& competitor) {
  const auto* ours = std::get_if<Candidate>(&competitor);
  return ours != nullptr ? std::string(name(ours->technique)) : is_embree(competitor) ? "embree" : "choice";
}

std::string parameters_of(const Competitor& competitor) {
  const auto* ours = std::get_if<Candidate>(&competitor);
  if (ours != nullptr) return describe(*ours);
  const auto* mode = std::get_if<EmbreeMode>(&competitor);
  return mode != nullptr ? describe(*mode) : "";
}

double CompetitorResult::median_seconds() const { return median(seconds); }

Race race(const Job& job, const RightHits& right, const EmbreePeer* embree, const std::vector<Competitor>& competitors,
          const RaceOptions& options) {
  return RaceRunner(job, right, embree, options).run_all(competitors);
}

}  // namespace detp::validate
