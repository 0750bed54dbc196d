#include "analysis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/validate/base/in_turns.hpp"
#include "detp/validate/base/own_time.hpp"
#include "detp/validate/base/search_work.hpp"
#include "detp/validate/base/stop_after.hpp"
#include "detp/validate/statistics/statistics.hpp"
#include "neighbours.hpp"

namespace detp::validate {
namespace {

constexpr double least_patience = 0.02;  // seconds
// Expected number of candidates, including the neighbours that are added during the analysis. Used only for progress.
constexpr std::size_t usually_tried = 16;

class Analyser {
 public:
  Analyser(const sim::Problem& problem, const AnalysisOptions& options) : problem_(problem), options_(options) {}

  /// Adds the candidates that are not in the analysis yet, and runs each once.
  void count(const std::vector<Analysed>& wanted) {
    const std::size_t first = all_.candidates.size();
    for (const Analysed& one : wanted)
      if (!has(one.candidate)) all_.candidates.push_back(one);
    for (std::size_t i = first; i < all_.candidates.size() && !options_.stop.stop_requested(); ++i) {
      report(i, expected_counting(i), remaining_after_counting(i));
      count_one(all_.candidates[i]);
    }
  }

  [[nodiscard]] std::vector<Candidate> leaders() const {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < first_seconds_.size(); ++i)
      if (all_.candidates[i].counted) places.push_back(i);
    std::sort(places.begin(), places.end(),
              [&](std::size_t a, std::size_t b) { return first_seconds_[a] < first_seconds_[b]; });
    places.resize(std::min(places.size(), options_.leaders));
    std::vector<Candidate> found;
    for (const std::size_t place : places) found.push_back(all_.candidates[place].candidate);
    return found;
  }

  [[nodiscard]] std::vector<Candidate> candidates() const {
    std::vector<Candidate> found;
    for (const Analysed& one : all_.candidates) found.push_back(one.candidate);
    return found;
  }

  Analysis finish() && {
    time_all();
    if (options_.stop.stop_requested())  // then a counting run is better than nothing
      for (std::size_t i = 0; i < all_.candidates.size(); ++i)
        if (Analysed& one = all_.candidates[i]; one.counted && !one.seconds) one.seconds = first_seconds_[i];
    for (std::size_t i = 0; i < all_.candidates.size(); ++i)
      if (const auto& seconds = all_.candidates[i].seconds;
          seconds && (!all_.best || *seconds < *all_.candidates[*all_.best].seconds))
        all_.best = i;
    if (all_.best && all_.candidates.front().seconds) {
      const Analysed& choice = all_.candidates.front();
      const Analysed& best = all_.candidates[*all_.best];
      all_.regret = *choice.seconds / *best.seconds - 1;
      if (*all_.best != 0) all_.regret_error = std::hypot(choice.spread, best.spread) / *best.seconds;
    }
    all_.stopped = options_.stop.stop_requested();
    return std::move(all_);
  }

 private:
  [[nodiscard]] bool has(const Candidate& candidate) const {
    return std::any_of(all_.candidates.begin(), all_.candidates.end(),
                       [&](const Analysed& one) { return one.candidate == candidate; });
  }

  void report(std::size_t place, double seconds, double remaining) const {
    if (!options_.progress) return;
    const Analysed& one = all_.candidates[place];
    const double done = watch_.seconds();
    const double whole = done + seconds + remaining;
    double work = 0;
    if (one.predicted && one.predicted->time.total() > 0)
      work = search_work(one.predicted->counts) * std::min(1.0, seconds / (slowness_ * one.predicted->time.total()));
    options_.progress({std::string(name(one.candidate.technique)), done / whole, (done + seconds) / whole, work,
                       work > 0 ? 0 : seconds});
  }

  [[nodiscard]] double patience() const { return std::max(least_patience, options_.patience * fastest_); }

  /// Expected seconds of a counting run. If it was run to its end: its measured seconds. If it has a prediction: the
  /// predicted seconds multiplied by slowness_, at most patience(). Otherwise patience(), or 0 before any run has
  /// ended.
  [[nodiscard]] double expected_counting(std::size_t place) const {
    if (place < first_seconds_.size() && std::isfinite(first_seconds_[place])) return first_seconds_[place];
    const Analysed& one = all_.candidates[place];
    if (!one.predicted) return std::isfinite(fastest_) ? patience() : 0;
    return std::min(patience(), slowness_ * one.predicted->time.total());
  }

  [[nodiscard]] double expected_timing() const {
    double seconds = 0;
    for (std::size_t i = 0; i < all_.candidates.size(); ++i) {
      const double once = expected_counting(i);
      const bool ends = i < first_seconds_.size() ? std::isfinite(first_seconds_[i]) : once < patience();
      if (ends) seconds += once * (once > options_.far_behind * fastest_ ? 1 : options_.repeats);
    }
    return seconds;
  }

  /// Expected seconds of the counting runs after number `place`, plus those of all timed runs.
  [[nodiscard]] double remaining_after_counting(std::size_t place) const {
    double seconds = expected_timing();
    for (std::size_t i = place + 1; i < all_.candidates.size(); ++i) seconds += expected_counting(i);
    const std::size_t later = all_.candidates.size() < usually_tried ? usually_tried - all_.candidates.size() : 0;
    const double neighbour = std::isfinite(fastest_) ? 1.5 * fastest_ : expected_counting(0);
    return seconds + static_cast<double>(later) * neighbour * (1 + options_.repeats);
  }

  void count_one(Analysed& one) {
    first_seconds_.push_back(std::numeric_limits<double>::infinity());
    const bool choice = all_.tried == 0;
    const double patience = this->patience();
    const OwnTime time(one.threads);
    const sim::Outcome outcome = choice ? run(one, true, options_.stop) : run_for(one, patience);
    if (options_.stop.stop_requested() || !one.refused.empty()) return;
    ++all_.tried;
    if (outcome.stopped) {
      one.given_up_after = patience;
      return;
    }
    one.counted = with_bytes_touched(outcome.counts, one.candidate, options_.engine);
    const double seconds = options_.check_seconds + time.own_part_of(outcome.seconds.total());
    first_seconds_.back() = seconds;
    fastest_ = std::min(fastest_, seconds);
    if (choice && one.predicted && one.predicted->time.total() > 0) slowness_ = seconds / one.predicted->time.total();
  }

  sim::Outcome run_for(Analysed& one, double seconds) {
    const StopAfter limit(options_.stop, seconds);
    return run(one, true, limit.token());
  }

  sim::Outcome run(Analysed& one, bool counting, const std::stop_token& stop) {
    sim::Outcome stopped;
    stopped.stopped = true;
    try {
      return sim::run(problem_, one.candidate,
                      {.count = counting, .engine = options_.engine, .stop = stop, .threads = one.threads});
    } catch (const sim::Stopped&) {
    } catch (const std::length_error& error) {
      one.refused = error.what();
    }
    return stopped;
  }

  void time_all() {
    std::vector<std::vector<double>> seconds(all_.candidates.size());
    double remaining = expected_timing();
    const auto begin = [](int /*round*/) { return true; };
    in_turns(all_.candidates.size(), options_.repeats, begin, [&](std::size_t i, int round) {
      Analysed& one = all_.candidates[i];
      if (!one.counted) return true;
      // The counting run alone may have been disturbed, above all the first of all. The choice is always timed as often.
      const double least = seconds[i].empty() ? first_seconds_[i] : std::min(first_seconds_[i], seconds[i].front());
      const bool behind = i > 0 && least > options_.far_behind * fastest_;
      if (behind && round > 0) return true;
      if (options_.stop.stop_requested()) return false;
      remaining -= first_seconds_[i];
      report(i, first_seconds_[i], std::max(0.0, remaining));
      const OwnTime time(one.threads);
      const sim::Outcome outcome = run(one, false, options_.stop);
      if (!outcome.stopped) seconds[i].push_back(options_.check_seconds + time.own_part_of(outcome.seconds.total()));
      return true;
    });
    for (std::size_t i = 0; i < all_.candidates.size(); ++i)
      if (!seconds[i].empty()) {
        const auto [low, high] = std::minmax_element(seconds[i].begin(), seconds[i].end());
        all_.candidates[i].seconds = median(seconds[i]);
        all_.candidates[i].spread = 0.5 * (*high - *low);
      }
  }

  const sim::Problem& problem_;
  const AnalysisOptions& options_;
  Analysis all_;
  std::vector<double> first_seconds_;  ///< of the counting runs; infinite if a run did not finish
  double fastest_ = std::numeric_limits<double>::infinity();
  double slowness_ = 1;  ///< measured / predicted seconds of the predicted choice
  sim::Stopwatch watch_;
};

}  // namespace

Analysis analyse(const sim::Problem& problem, const std::vector<Prediction>& ranking, const AnalysisOptions& options) {
  const sim::DefaultFloatingPoint mode;
  const auto predicted = [&](const std::vector<Candidate>& candidates) {
    std::vector<Analysed> all;
    for (const Candidate& candidate : candidates) {
      auto prediction = options.predict ? options.predict(candidate) : std::optional<Prediction>{};
      const WorkDivision& division = record_of(candidate.technique).division;
      const bool divided =
          division.preparing || (options.engine == Engine::plain ? division.plain : division.simd) != Division::none;
      const int threads = prediction ? prediction->threads : divided ? options.threads : 1;
      all.push_back({.candidate = candidate, .threads = threads, .predicted = std::move(prediction)});
    }
    return all;
  };
  Analyser analyser(problem, options);
  std::vector<Analysed> ranked;
  for (const Prediction& one : ranking)
    ranked.push_back({.candidate = one.candidate, .threads = one.threads, .predicted = one});
  analyser.count(ranked);
  std::vector<Candidate> left_out = techniques_left_out(analyser.candidates());
  std::erase_if(left_out, [&](const Candidate& one) {
    return std::find(options.disabled.begin(), options.disabled.end(), one.technique) != options.disabled.end();
  });
  analyser.count(predicted(left_out));
  for (const Candidate& leader : analyser.leaders()) analyser.count(predicted(neighbours(leader)));
  return std::move(analyser).finish();
}

}  // namespace detp::validate
