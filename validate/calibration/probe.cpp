#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <span>
#include <vector>

#include "built_in_costs.hpp"
#include "calibration_file.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/validate/measure/rounds.hpp"
#include "timed_workloads.hpp"

namespace detp::validate {
namespace {

constexpr double seconds_of_probe = 0.2;
constexpr int rounds_of_probe = 3;

/// ln(measured over predicted seconds), of some searches.
struct Ratios {
  double sum = 0;
  int count = 0;

  void add(double measured, double predicted) {
    if (measured > 0 && predicted > 0) sum += std::log(measured / predicted), ++count;
  }
  void add(const Ratios& more) { sum += more.sum, count += more.count; }
  [[nodiscard]] double mean() const { return count > 0 ? std::exp(sum / count) : 1; }
};

/// Of sorting and building, and of the rest: another processor makes each faster by another factor.
struct PhaseRatios {
  Ratios preparing;
  Ratios search;

  void add(const PhaseRatios& more) { preparing.add(more.preparing), search.add(more.search); }
  [[nodiscard]] double factor(const UnitCostTerm& term) const {
    const bool prepares = term.part == &CostBreakdown::order || term.part == &CostBreakdown::build;
    return (prepares && preparing.count > 0 ? preparing : search).mean();
  }
};

/// Of middling speed for a thousand discs; default_candidate() of cells is for many more.
Candidate probed_candidate(Technique technique) {
  if (technique == Technique::octree) return {technique, OctreeParameters{4}};
  if (technique == Technique::grid) return {technique, GridParameters{12}};
  return default_candidate(technique);
}

class Probe {
 public:
  explicit Probe(const std::stop_token& stop) : stop_(stop) {}

  Calibration run() && {
    const sim::DefaultFloatingPoint mode;
    add({sim::Body::cube_faces, 1000, 1500, 0.03}, 0, exact_techniques);
    add({sim::Body::cube, 700, 1000, 0.05}, 6, exact_techniques);
    constexpr std::array large{Technique::box_tree};  // the technique of most answers
    add({sim::Body::cube_faces, 40'000, 40'000, 0.0025}, 6, large);
    // In rounds: a processor that is fast or slow for some milliseconds is so for one of them.
    in_turns(timed_.size(), std::numeric_limits<int>::max(), [&](std::size_t i, int round) {
      if (stop_.stop_requested() || (round >= rounds_of_probe && watch_.seconds() > seconds_of_probe)) return false;
      time(timed_[i], round);
      return true;
    });
    for (const TimedCandidate& one : timed_) learn(one);
    Calibration found;
    found.probe = true;
    found.left_out_median_error = probe_error;
    for (const Engine engine : {Engine::simd, Engine::plain}) set(found.of(engine), engine);
    set_touch_cost(found);
    return found;
  }

 private:
  void add(const TimedWorkload& workload, std::size_t place, std::span<const Technique> techniques) {
    const TimedScene& scene = scenes_.emplace_back(workload, place);
    for (const Engine engine : {Engine::simd, Engine::plain})
      for (const Technique technique : techniques)
        if (engine == Engine::simd || (record_of(technique).simd && scenes_.size() == 1))
          timed_.push_back({&scene, probed_candidate(technique), engine});
  }

  /// The first run of a round brings the data into the caches; that of the first round touches memory for the first time.
  void time(TimedCandidate& one, int round) {
    const sim::RunOptions how{.count = round == 0, .engine = one.engine, .stop = stop_};
    const sim::Outcome first = sim::run(one.scene->problem, one.candidate, how);
    if (first.stopped) return;
    if (how.count) one.counts = as_expected(first.counts);
    const RunTime second =
        time_run(one.scene->problem, one.candidate, {.count = false, .engine = one.engine, .stop = stop_});
    if (second.outcome.stopped) return;
    one.times.front().begin_round();
    one.times.front().add(second.seconds, second.preparing);
  }

  /// The usual times count. The least would be wrong: now and then a virtual machine's clock of processor time shows a thirtieth of
  /// what passed.
  void learn(const TimedCandidate& one) {
    const RoundTimes& times = one.times.front();
    if (times.rounds() == 0) return;
    const CostBreakdown predicted = price(one.counts, built_in_unit_costs(one.engine), one.candidate.technique);
    PhaseRatios& ratios = of(one.engine, one.candidate.technique);
    const double preparing = predicted.order + predicted.build;
    ratios.preparing.add(times.usual_preparing() + one.scene->checking_discs, preparing);
    ratios.search.add(times.usual_search() + one.scene->checking_rays, predicted.total() - preparing);
  }

  void set(CostTable& costs, Engine engine) {
    PhaseRatios all;
    for (const Technique technique : all_techniques) all.add(of(engine, technique));
    costs = built_in_unit_costs(engine);
    for (const Technique technique : all_techniques) {
      const PhaseRatios& measured = of(record_of(technique).simd ? engine : Engine::simd, technique);
      const PhaseRatios& used = measured.search.count > 0 ? measured : all;
      for (const UnitCostTerm& term : unit_cost_terms) costs[technique].*term.cost *= used.factor(term);
      costs.threads_of(technique).start *= used.search.mean();
      costs.relative_error_of(technique) = CalibrationQuality{probe_error, 1}.relative_error();
    }
  }

  [[nodiscard]] PhaseRatios& of(Engine engine, Technique technique) {
    return ratios_[static_cast<std::size_t>(engine)][static_cast<std::size_t>(technique)];
  }

  const std::stop_token& stop_;
  sim::Stopwatch watch_;
  std::deque<TimedScene> scenes_;
  std::vector<TimedCandidate> timed_;
  std::array<std::array<PhaseRatios, technique_records.size()>, 2> ratios_ = {};  ///< by engine
};

}  // namespace

Calibration probe(const std::stop_token& stop) { return Probe(stop).run(); }

}  // namespace detp::validate
