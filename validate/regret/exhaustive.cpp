#include "exhaustive.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/base/in_turns.hpp"
#include "detp/validate/base/stop_after.hpp"
#include "detp/validate/choice/neighbours.hpp"

namespace detp::validate {
namespace {

constexpr double least_patience = 0.005;
constexpr int most_rounds_of_neighbours = 6;
constexpr double infinite = std::numeric_limits<double>::infinity();

double least_of_every_second(const std::vector<double>& seconds, std::size_t first) {
  double least = infinite;
  for (std::size_t i = first; i < seconds.size(); i += 2) least = std::min(least, seconds[i]);
  return least;
}

class Search {
 public:
  Search(const sim::Problem& problem, const ExhaustiveOptions& options) : problem_(problem), options_(options) {}

  /// Runs the candidates once, unless they have been run.
  void add(std::span<const Candidate> candidates) {
    for (const Candidate& candidate : candidates)
      if (!options_.stop.stop_requested() && !has(candidate)) run_first(candidate);
  }

  [[nodiscard]] std::vector<Candidate> candidates() const {
    std::vector<Candidate> all;
    for (const Timed& one : found_.candidates) all.push_back(one.candidate);
    return all;
  }

  void add_neighbours() {
    for (int round = 0; round < most_rounds_of_neighbours; ++round) {
      const std::size_t before = found_.candidates.size();
      for (const Candidate& leader : leaders()) add(neighbours(leader));
      if (found_.candidates.size() == before) return;
    }
  }

  Exhaustive time_all(std::size_t asked) && {
    in_turns(found_.candidates.size(), options_.repeats, [&](std::size_t i, int round) {
      if (options_.stop.stop_requested()) return false;
      if (first_[i] > options_.behind * fastest_ && (i >= asked || round >= 2)) return true;
      if (!found_.candidates[i].abandoned) time(found_.candidates[i]);
      return true;
    });
    double least = infinite;
    for (std::size_t i = 0; i < found_.candidates.size(); ++i) {
      const Timed& one = found_.candidates[i];
      if (one.abandoned || one.seconds.size() < 2 || one.selecting_seconds() >= least) continue;
      least = one.selecting_seconds();
      found_.best = i;
    }
    const Timed& best = found_.candidates[found_.best];
    found_.noise = best.judging_seconds() / best.selecting_seconds();
    found_.stopped = options_.stop.stop_requested();
    return std::move(found_);
  }

 private:
  [[nodiscard]] bool has(const Candidate& candidate) const {
    return std::any_of(found_.candidates.begin(), found_.candidates.end(),
                       [&](const Timed& one) { return one.candidate == candidate; });
  }

  [[nodiscard]] std::vector<Candidate> leaders() const {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < first_.size(); ++i)
      if (!found_.candidates[i].abandoned) places.push_back(i);
    std::sort(places.begin(), places.end(), [&](std::size_t a, std::size_t b) { return first_[a] < first_[b]; });
    places.resize(std::min<std::size_t>(places.size(), 2));
    std::vector<Candidate> found;
    for (const std::size_t place : places) found.push_back(found_.candidates[place].candidate);
    return found;
  }

  void run_first(const Candidate& candidate) {
    Timed one{.candidate = candidate};
    const double patience = std::max(least_patience, options_.patience * fastest_);
    sim::Outcome outcome;
    try {
      const StopAfter limit(options_.stop, fastest_ < infinite ? patience : 1e6);
      outcome = sim::run(problem_, candidate, {.stop = limit.token(), .threads = options_.threads});
    } catch (const std::length_error&) {  // its index does not fit in memory
      return;
    }
    one.abandoned = outcome.stopped;
    const double seconds = one.abandoned ? patience : outcome.seconds.total();
    if (one.abandoned) one.seconds = {patience, patience};
    if (!one.abandoned) {
      one.counts = outcome.counts;
      one.vectors = outcome.vectors;
      fastest_ = std::min(fastest_, seconds);
    }
    first_.push_back(seconds);
    found_.candidates.push_back(std::move(one));
  }

  void time(Timed& one) {
    const sim::Phases phases = sim::run(problem_, one.candidate, {.count = false, .threads = options_.threads}).seconds;
    if (one.seconds.empty() || phases.total() < one.phases.total()) one.phases = phases;
    one.seconds.push_back(phases.total());
  }

  const sim::Problem& problem_;
  const ExhaustiveOptions& options_;
  Exhaustive found_;
  std::vector<double> first_;  ///< seconds of the first run of each
  double fastest_ = infinite;
};

}  // namespace

double Timed::selecting_seconds() const { return least_of_every_second(seconds, 0); }
double Timed::judging_seconds() const { return least_of_every_second(seconds, 1); }

Exhaustive measure_all(const sim::Problem& problem, std::span<const Candidate> asked,
                       const ExhaustiveOptions& options) {
  Search search(problem, options);
  search.add(asked);
  search.add(techniques_left_out(search.candidates()));
  search.add_neighbours();
  return std::move(search).time_all(asked.size());
}

}  // namespace detp::validate
