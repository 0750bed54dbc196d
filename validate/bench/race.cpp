#include "race.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/validate/choice/pilot.hpp"
#include "detp/validate/measure/in_turns.hpp"
#include "detp/validate/measure/own_time.hpp"
#include "detp/validate/statistics/statistics.hpp"

namespace detp::validate {
namespace {

constexpr int least_rounds = 3;

class RaceRunner {
 public:
  RaceRunner(const Job& job, const RightHits& right, const EmbreePeer& embree, const RaceOptions& options)
      : job_(job), right_(right), embree_(embree), options_(options) {}

  Race run_all(const std::vector<Competitor>& competitors) {
    for (const Competitor& competitor : competitors) race_.results.push_back({competitor});
    finalist_.assign(competitors.size(), false);
    const auto begin = [&](int round) {
      if (round == 1) {
        choose_finalists(is_own_technique);
        choose_finalists(is_embree);
      }
      return round < least_rounds || watch_.seconds() < options_.most_seconds;
    };
    in_turns(competitors.size(), options_.repeats, begin, [&](std::size_t i, int round) {
      CompetitorResult& result = race_.results[i];
      return (round > 0 && !finalist_[i] && !std::holds_alternative<OwnChoice>(result.competitor)) || run(result);
    });
    std::erase_if(race_.results, [](const CompetitorResult& result) { return result.seconds.empty(); });
    race_.complete = race_.results.size() == competitors.size();
    return std::move(race_);
  }

 private:
  /// Reports the next run. In the first round it is expected to take as long as the mean of the runs before it, later
  /// as long as the competitor's first run.
  void report(const CompetitorResult& next) {
    if (!options_.progress) return;
    constexpr double first_round = 0.8;  // expected share of the time of the race
    const bool first = next.seconds.empty();
    const double step = first ? first_round / static_cast<double>(race_.results.size())
                              : (1 - first_round) / (2.0 * options_.finalists * std::max(1, options_.repeats - 1));
    const double before = std::exchange(share_, std::min(1.0, share_ + step));
    options_.progress({technique_of(next.competitor), before, share_, 0,
                       first ? watch_.seconds() / std::max(1.0, before / step) : next.seconds.front()});
  }

  /// Returns false if a stop request ended the run.
  bool run(CompetitorResult& result) {
    report(result);
    const OwnTime time(options_.threads);
    if (const auto* mode = std::get_if<EmbreeMode>(&result.competitor)) {
      const PeerOutcome outcome = embree_.run(job_.rays, job_.discs, *mode, options_.stop);
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
          options_.costs);
      how.threads = choice.best().threads;
      const sim::Outcome outcome = sim::run(problem, *build_choice(choice, problem, how), how);
      return record_run(result, outcome, time.seconds());
    } catch (const sim::Stopped&) {
      return false;
    }
  }

  template <class Outcome>
  bool record_run(CompetitorResult& result, const Outcome& outcome, double seconds) const {
    if (outcome.stopped) return false;
    result.seconds.push_back(seconds);
    result.hits = std::accumulate(outcome.hits.begin(), outcome.hits.end(), std::uint64_t{0});
    result.wrong_hits = std::max(result.wrong_hits, right_.wrong_hits(outcome.hits));
    return true;
  }

  /// Those of a side that were the fastest in the first round run in all later ones.
  void choose_finalists(bool (*of_side)(const Competitor&)) {
    std::vector<std::size_t> side;
    for (std::size_t i = 0; i < race_.results.size(); ++i)
      if (of_side(race_.results[i].competitor) && !race_.results[i].seconds.empty()) side.push_back(i);
    std::ranges::stable_sort(side, {}, [&](std::size_t i) { return race_.results[i].seconds.front(); });
    side.resize(std::min(side.size(), static_cast<std::size_t>(options_.finalists)));
    for (const std::size_t i : side) finalist_[i] = true;
  }

  const Job& job_;
  const RightHits& right_;
  const EmbreePeer& embree_;
  const RaceOptions& options_;
  sim::Stopwatch watch_;
  double share_ = 0;  ///< share of the time that is done after the current run
  std::vector<bool> finalist_;
  Race race_;
};

}  // namespace

std::uint64_t RightHits::wrong_hits(std::span<const std::uint64_t> others) const {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) sum += hits[i] > others[i] ? hits[i] - others[i] : others[i] - hits[i];
  return sum;
}

std::optional<RightHits> right_hits(const Job& job, const Candidate& exact, double checkable,
                                    const std::stop_token& stop) {
  const double pairs = static_cast<double>(job.rays.size()) * static_cast<double>(job.discs.size());
  const Candidate judge = pairs <= checkable ? Candidate{Technique::brute_force, BruteForceParameters{}} : exact;
  sim::Outcome outcome = sim::run(job.problem(), judge, {.count = false, .stop = stop, .threads = 0});
  if (outcome.stopped) return std::nullopt;
  return RightHits{judge.technique, std::move(outcome.hits)};
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

Race race(const Job& job, const RightHits& right, const EmbreePeer& embree, const std::vector<Competitor>& competitors,
          const RaceOptions& options) {
  return RaceRunner(job, right, embree, options).run_all(competitors);
}

}  // namespace detp::validate
