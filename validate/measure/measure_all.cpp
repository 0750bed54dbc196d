#include "measure_all.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "detp/validate/statistics/statistics.hpp"
#include "rounds.hpp"

namespace detp::validate {
namespace {

constexpr double short_run = 0.02;     ///< seconds; the first time of shorter runs is the shortest of three
constexpr double enough_timed = 0.04;  ///< seconds of the fastest; more rounds of a half are not needed
constexpr int most_rounds = 60;        ///< of a half, unless more repeats are asked for
constexpr int most_attempts = 4;       ///< of a first run
/// A candidate takes part in the selection if its first time is at most this many times the fastest. First runs do not
/// take turns, so the machine's speed may have changed between two of them.
constexpr double may_be_fastest = 3;
/// While the best is selected, one that is slower by more than this factor is timed in four rounds only.
constexpr double behind = 1.5;
/// A judged candidate is timed in every round, unless it takes more than this many times as long as the fastest.
constexpr double hopelessly_behind = 3;
constexpr double infinite = std::numeric_limits<double>::infinity();
// Expected shares of the time, for progress only.
constexpr double share_of_first_runs = 0.5;
constexpr double share_of_selecting = 0.3;

std::vector<ParameterValue> steps_from(const Parameter& parameter, const ParameterValue& value) {
  if (const auto* ratio = std::get_if<double>(&value)) return {(2 - parameter.step) * *ratio, parameter.step * *ratio};
  const auto number = std::get<std::int64_t>(value);
  if (parameter.step == 0) return {number - 1, number + 1};
  return {static_cast<std::int64_t>(std::llround(static_cast<double>(number) / parameter.step)),
          static_cast<std::int64_t>(std::llround(static_cast<double>(number) * parameter.step))};
}

/// Adds nothing if `value` is not in the parameter's range or not a change.
void add_changed(std::vector<Candidate>& all, Candidate candidate, const Parameter& parameter,
                 const ParameterValue& value) {
  const ParameterValue now = parameter.get(candidate.parameters);
  try {
    set_parameter(candidate, parameter.name, value);
  } catch (const std::invalid_argument&) {
    return;
  }
  if (parameter.get(candidate.parameters) != now) all.push_back(candidate);
}

class Search {
 public:
  Search(const sim::Problem& problem, const ExhaustiveOptions& options) : problem_(problem), options_(options) {}

  /// Runs them once, unless they have been run.
  void add(std::span<const Contender> contenders, double patience) {
    for (const Contender& contender : contenders)
      if (!stopped() && !has(contender)) run_first(contender, patience);
  }

  void add_others() {
    std::vector<Candidate> asked;
    for (const Timed& one : found_.candidates) asked.push_back(one.contender.candidate);
    asked_ = asked.size();
    for (const Refused& one : found_.refused) asked.push_back(one.contender.candidate);
    std::vector<Contender> others;
    for (const Candidate& candidate : techniques_left_out(asked))
      if (std::ranges::find(options_.disabled, candidate.technique) == options_.disabled.end())
        others.push_back({candidate, is_divided(candidate.technique) ? options_.threads : 1});
    add(others, options_.patience);
    for (int round = 0; round < options_.rounds_of_neighbours; ++round) {
      const std::size_t before = found_.candidates.size();
      for (const Contender& leader : leaders()) add(near(leader), options_.patience);
      if (found_.candidates.size() == before) return;
    }
  }

  void select() {
    report("selecting the best", share_of_first_runs, share_of_first_runs + share_of_selecting);
    std::vector<Timed*> entries;
    for (Timed& one : found_.candidates)
      if (!one.abandoned && one.first_seconds <= may_be_fastest * fastest_) entries.push_back(&one);
    time_in_turns(entries, behind, &Timed::selecting);
    found_.best = fastest_selected(found_.candidates);
  }

  void judge() {
    if (!found_.best) return;
    report("judging", share_of_first_runs + share_of_selecting, 1);
    Timed& best = found_.candidates[*found_.best];
    Timed twin = best;
    std::vector<Timed*> entries;
    for (std::size_t i = 0; i < found_.candidates.size(); ++i)
      if (Timed& one = found_.candidates[i]; &one == &best || (i < asked_ && !one.abandoned)) entries.push_back(&one);
    entries.push_back(&twin);
    time_in_turns(entries, hopelessly_behind, &Timed::judging);
    if (!best.judging.empty() && !twin.judging.empty()) found_.noise = twin.judged_ratio(best);
  }

  Exhaustive result() && {
    found_.stopped = stopped();
    return std::move(found_);
  }

 private:
  [[nodiscard]] bool stopped() const { return options_.stop.stop_requested(); }

  /// Of first runs it is known only roughly how many there will be.
  void report_first(const Contender& contender) {
    constexpr double usual = 24;
    const double from = share_of_first_runs * first_runs_ / (first_runs_ + usual);
    ++first_runs_;
    report(name(contender.candidate.technique), from, share_of_first_runs * first_runs_ / (first_runs_ + usual));
  }

  void report(std::string_view what, double from, double to) const {
    if (options_.progress) options_.progress({std::string(what), from, to});
  }

  [[nodiscard]] bool has(const Contender& contender) const {
    return found_.find(contender) != nullptr ||
           std::ranges::find(found_.refused, contender, &Refused::contender) != found_.refused.end();
  }

  /// Whether several threads can share its search, or its sorting and building.
  [[nodiscard]] bool is_divided(Technique technique) const {
    const WorkDivision& division = record_of(technique).division;
    return division.preparing || (options_.engine == Engine::plain ? division.plain : division.simd) != Division::none;
  }

  /// The candidate's neighbours, and the candidate on half and twice as many threads.
  [[nodiscard]] std::vector<Contender> near(const Contender& contender) const {
    std::vector<Contender> all;
    for (const Candidate& candidate : neighbours(contender.candidate)) all.push_back({candidate, contender.threads});
    for (const int threads : {contender.threads / 2, contender.threads * 2})
      if (options_.vary_threads && threads >= 1 && threads <= options_.threads)
        all.push_back({contender.candidate, threads});
    return all;
  }

  [[nodiscard]] std::vector<Contender> leaders() const {
    std::vector<const Timed*> finished;
    for (const Timed& one : found_.candidates)
      if (!one.abandoned) finished.push_back(&one);
    std::sort(finished.begin(), finished.end(),
              [](const Timed* a, const Timed* b) { return a->first_seconds < b->first_seconds; });
    finished.resize(std::min<std::size_t>(finished.size(), 2));
    std::vector<Contender> first;
    for (const Timed* one : finished) first.push_back(one->contender);
    return first;
  }

  /// Runs it once, and abandons it after `limit` seconds; if other programs took most of these, begins again.
  void run_within(double limit, Timed& one) const {
    for (int attempt = 0; attempt < most_attempts; ++attempt) {
      const auto& [candidate, threads] = one.contender;
      const StopAfter clock(options_.stop, limit);
      const RunTime run =
          time_run(problem_, candidate, {.engine = options_.engine, .stop = clock.token(), .threads = threads});
      one.abandoned = run.outcome.stopped;
      one.first_seconds = one.abandoned ? limit : run.seconds;
      if (!one.abandoned) one.counts = run.outcome.counts;
      if (!one.abandoned || run.seconds > limit / 2 || stopped()) return;
    }
  }

  void run_first(const Contender& contender, double patience) {
    report_first(contender);
    Timed one{.contender = contender};
    try {
      run_within(fastest_ < infinite ? std::max(options_.least_patience, patience * fastest_) : 1e9, one);
    } catch (const std::length_error& error) {
      found_.refused.push_back({contender, error.what()});
      return;
    }
    if (!one.abandoned && one.first_seconds < short_run) {
      const auto second = time(one);
      const auto third = time(one);
      if (!second || !third) return;
      one.first_seconds = std::min(*second, *third);
    }
    if (stopped()) return;
    if (!one.abandoned) fastest_ = std::min(fastest_, one.first_seconds);
    found_.candidates.push_back(std::move(one));
  }

  /// The time of a run without counting; nullopt if a stop request ended the run.
  [[nodiscard]] std::optional<double> time(const Timed& one) const {
    const auto& [candidate, threads] = one.contender;
    const RunTime run = time_run(
        problem_, candidate, {.count = false, .engine = options_.engine, .stop = options_.stop, .threads = threads});
    return run.outcome.stopped ? std::nullopt : std::optional(run.seconds);
  }

  void time_in_turns(const std::vector<Timed*>& entries, double most_behind, std::vector<double> Timed::*half) const {
    const double enough = std::min<double>(most_rounds, std::ceil(enough_timed / fastest_));
    const auto times = timed_rounds(
        entries.size(),
        {.rounds = std::max(options_.repeats, static_cast<int>(enough)), .most_seconds = options_.most_seconds},
        [&](const TimesOfAll& so_far) { return not_behind(so_far, most_behind); },
        [&](std::size_t i, std::span<const double>) { return time(*entries[i]); });
    for (std::size_t i = 0; i < entries.size(); ++i) entries[i]->*half = times[i];
  }

  const sim::Problem& problem_;
  const ExhaustiveOptions& options_;
  Exhaustive found_;
  std::size_t asked_ = 0;      ///< number of candidates asked for that fit in memory
  double first_runs_ = 0;      ///< so far
  double fastest_ = infinite;  ///< shortest first_seconds of those that were not abandoned
};

}  // namespace

std::vector<Candidate> techniques_left_out(const std::vector<Candidate>& candidates) {
  std::vector<Candidate> left_out;
  for (const Technique technique : exact_techniques) {
    const bool there = std::any_of(candidates.begin(), candidates.end(),
                                   [&](const Candidate& candidate) { return candidate.technique == technique; });
    if (!there) left_out.push_back(default_candidate(technique));
  }
  return left_out;
}

std::vector<Candidate> neighbours(const Candidate& candidate) {
  std::vector<Candidate> all;
  const auto& parameters = record_of(candidate.technique).parameters;
  for (const Parameter& parameter : parameters) {
    const ParameterValue now = parameter.get(candidate.parameters);
    if (parameter.choices.empty()) {
      for (const ParameterValue& value : steps_from(parameter, now)) add_changed(all, candidate, parameter, value);
    } else if (parameters.size() == 1) {  // the choice is the only parameter to vary
      for (const std::string_view choice : parameter.choices) add_changed(all, candidate, parameter, choice);
    }
  }
  return all;
}

double Timed::judging_seconds() const { return abandoned ? first_seconds : median(judging); }

double Timed::judged_ratio(const Timed& reference) const {
  return abandoned ? first_seconds / reference.judging_seconds() : median_ratio(judging, reference.judging);
}

std::optional<std::size_t> fastest_selected(std::span<const Timed> candidates) {
  // One that took part in every round, so that it shares rounds with all others.
  const auto longest = std::max_element(candidates.begin(), candidates.end(), [](const Timed& a, const Timed& b) {
    return a.selecting.size() < b.selecting.size();
  });
  std::optional<std::size_t> best;
  double least = infinite;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i].selecting.empty()) continue;
    const double ratio = median_ratio(candidates[i].selecting, longest->selecting);
    if (!best || ratio < least) {
      best = i;
      least = ratio;
    }
  }
  return best;
}

const Timed* Exhaustive::find(const Contender& contender) const {
  const auto found =
      std::find_if(candidates.begin(), candidates.end(), [&](const Timed& one) { return one.contender == contender; });
  return found == candidates.end() ? nullptr : &*found;
}

Exhaustive measure_all(const sim::Problem& problem, std::span<const Contender> asked,
                       const ExhaustiveOptions& options) {
  Search search(problem, options);
  search.add(asked, options.patience_if_asked);
  search.add_others();
  search.select();
  search.judge();
  return std::move(search).result();
}

}  // namespace detp::validate
