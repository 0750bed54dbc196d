#include "race.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "detp/sim/base/stopwatch.hpp"
#include "detp/validate/base/in_turns.hpp"
#include "detp/validate/statistics/statistics.hpp"

namespace detp::validate {
namespace {

/// The smallest number of rounds for a meaningful median.
constexpr int least_rounds = 3;

class Runner {
 public:
  Runner(const Job& job, const RightHits& right, const EmbreePeer& embree, const RaceOptions& options)
      : job_(job), right_(right), embree_(embree), options_(options) {}

  Race go(const std::vector<Competitor>& competitors) {
    for (const Competitor& competitor : competitors) race_.finishes.push_back({competitor});
    double ours = 0;
    double peers = 0;
    in_turns(competitors.size(), options_.repeats, [&](std::size_t i, int round) {
      Finish& finish = race_.finishes[i];
      if (round == 0) return run(finish);
      if (i == 0 && round >= least_rounds && watch_.seconds() >= options_.enough) return false;
      if (i == 0 && round == 1) {
        ours = slowest_finalist(true);
        peers = slowest_finalist(false);
      }
      return finish.seconds.front() > (is_ours(finish.competitor) ? ours : peers) || run(finish);
    });
    std::erase_if(race_.finishes, [](const Finish& finish) { return finish.seconds.empty(); });
    race_.complete = race_.finishes.size() == competitors.size();
    return std::move(race_);
  }

 private:
  /// Reports the next run. A run without earlier measurements is expected to take as long as those before it.
  void report(const Finish& next) {
    if (!options_.progress) return;
    constexpr double first_round = 0.8;  // share of the time; afterwards only the fastest continue
    const bool first = next.seconds.empty();
    const double step = first ? first_round / static_cast<double>(race_.finishes.size())
                              : (1 - first_round) / (2.0 * options_.finalists * std::max(1, options_.repeats - 1));
    const double before = std::exchange(share_, std::min(1.0, share_ + step));
    options_.progress({technique_of(next.competitor), before, share_, 0,
                       first ? watch_.seconds() / std::max(1.0, before / step) : next.seconds.front()});
  }

  /// One run. Returns whether it was completed.
  bool run(Finish& finish) {
    report(finish);
    const sim::Stopwatch watch;
    if (const auto* mode = std::get_if<EmbreeMode>(&finish.competitor)) {
      const PeerOutcome outcome = embree_.run(job_.rays, job_.discs, *mode, options_.stop);
      return note(finish, outcome, watch.seconds());
    }
    const sim::Outcome outcome =
        sim::run(job_.problem(options_.threads, options_.stop), std::get<Candidate>(finish.competitor),
                 {.count = false, .stop = options_.stop, .threads = options_.threads});
    return note(finish, outcome, watch.seconds());
  }

  template <class Outcome>
  bool note(Finish& finish, const Outcome& outcome, double seconds) const {
    if (outcome.stopped) return false;
    finish.seconds.push_back(seconds);
    finish.hits = std::accumulate(outcome.hits.begin(), outcome.hits.end(), std::uint64_t{0});
    finish.wrong_hits = std::max(finish.wrong_hits, right_.wrong(outcome.hits));
    return true;
  }

  /// The first-round time of the slowest finalist of a side.
  [[nodiscard]] double slowest_finalist(bool ours) const {
    std::vector<double> first;
    for (const Finish& finish : race_.finishes)
      if (is_ours(finish.competitor) == ours && !finish.seconds.empty()) first.push_back(finish.seconds.front());
    if (first.empty()) return 0;
    std::sort(first.begin(), first.end());
    return first[std::min(first.size(), static_cast<std::size_t>(options_.finalists)) - 1];
  }

  const Job& job_;
  const RightHits& right_;
  const EmbreePeer& embree_;
  const RaceOptions& options_;
  sim::Stopwatch watch_;
  double share_ = 0;  ///< share of the time that is done after the current run
  Race race_;
};

}  // namespace

std::string technique_of(const Competitor& competitor) {
  const auto* ours = std::get_if<Candidate>(&competitor);
  return ours != nullptr ? std::string(name(ours->technique)) : "embree";
}

std::string parameters_of(const Competitor& competitor) {
  const auto* ours = std::get_if<Candidate>(&competitor);
  return ours != nullptr ? describe(*ours) : describe(std::get<EmbreeMode>(competitor));
}

double Finish::median_seconds() const { return median(seconds); }

Race race(const Job& job, const RightHits& right, const EmbreePeer& embree, const std::vector<Competitor>& competitors,
          const RaceOptions& options) {
  return Runner(job, right, embree, options).go(competitors);
}

}  // namespace detp::validate
