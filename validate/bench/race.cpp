#include "race.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <optional>

namespace detp::validate {
namespace {

using Clock = std::chrono::steady_clock;

/// As many as a median needs to be worth the name.
constexpr int least_rounds = 3;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

class Runner {
 public:
  Runner(const Job& job, const RightHits& right, const EmbreePeer& embree, const RaceOptions& options)
      : job_(job), right_(right), embree_(embree), options_(options) {}

  Race go(const std::vector<Competitor>& competitors) {
    const auto start = Clock::now();
    for (const Competitor& competitor : competitors) race_.finishes.push_back({competitor});
    race_.complete = round([](const Finish&) { return true; });
    const double ours = slowest_finalist(true);
    const double peers = slowest_finalist(false);
    for (int i = 1; i < options_.repeats && race_.complete; ++i) {
      if (i >= least_rounds && seconds_since(start) >= options_.enough) break;
      const bool whole = round(
          [&](const Finish& finish) { return finish.seconds.front() <= (is_ours(finish.competitor) ? ours : peers); });
      if (!whole) break;
    }
    std::erase_if(race_.finishes, [](const Finish& finish) { return finish.seconds.empty(); });
    return std::move(race_);
  }

 private:
  /// Whether all that should have run to their end.
  template <class Predicate>
  bool round(const Predicate& takes_part) {
    return std::all_of(race_.finishes.begin(), race_.finishes.end(),
                       [&](Finish& finish) { return !takes_part(finish) || run(finish); });
  }

  /// One run; whether it came to its end.
  bool run(Finish& finish) const {
    const auto start = Clock::now();
    if (const auto* mode = std::get_if<EmbreeMode>(&finish.competitor)) {
      const PeerOutcome outcome = embree_.run(job_.rays, job_.discs, *mode, options_.stop);
      return note(finish, outcome, seconds_since(start));
    }
    const sim::Outcome outcome =
        sim::run(job_.problem(options_.threads, options_.stop), std::get<Candidate>(finish.competitor),
                 {.count = false, .stop = options_.stop, .threads = options_.threads});
    return note(finish, outcome, seconds_since(start));
  }

  template <class Outcome>
  bool note(Finish& finish, const Outcome& outcome, double seconds) const {
    if (outcome.stopped) return false;
    finish.seconds.push_back(seconds);
    finish.hits = std::accumulate(outcome.hits.begin(), outcome.hits.end(), std::uint64_t{0});
    finish.wrong_hits = std::max(finish.wrong_hits, right_.wrong(outcome.hits));
    return true;
  }

  /// The first round's time of the last finalist of a side.
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

double Finish::median_seconds() const {
  std::vector<double> sorted = seconds;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t middle = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
}

Race race(const Job& job, const RightHits& right, const EmbreePeer& embree, const std::vector<Competitor>& competitors,
          const RaceOptions& options) {
  return Runner(job, right, embree, options).go(competitors);
}

}  // namespace detp::validate
