#include "probe.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <filesystem>
#include <memory>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include "built_in_costs.hpp"
#include "calibration_file.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/technique/technique.hpp"
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

/// The middle one, the lower of two. The least would be wrong: now and then a virtual machine's clock of processor time shows a thirtieth of what
/// passed.
double usual(std::vector<double> seconds) {
  const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>((seconds.size() - 1) / 2);
  std::ranges::nth_element(seconds, middle);
  return *middle;
}

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
    for (int round = 0; round < rounds_of_probe || !is_over(); ++round)
      for (Timed& one : timed_)
        if (!stop_.stop_requested() && (round < rounds_of_probe || !is_over())) time(one, round);
    for (const Timed& one : timed_) learn(one);
    Calibration found;
    found.probe = true;
    found.left_out_median_error = probe_error;
    for (const Engine engine : {Engine::simd, Engine::plain}) set(found.of(engine).costs, engine);
    set_touch_cost(found);
    found.seconds = watch_.seconds();
    return found;
  }

 private:
  struct Workload {
    std::vector<sim::Disc> discs;
    std::vector<sim::Ray> rays;
    sim::Problem problem = sim::make_problem(rays, discs);  // borrows both
    CheckSeconds checks = time_checks(problem, rays, discs);
  };
  struct Timed {
    const Workload* workload;
    Candidate candidate;
    Engine engine;
    Counts<double> counts = {};
    std::vector<double> preparing = {};
    std::vector<double> search = {};
  };

  [[nodiscard]] bool is_over() const { return watch_.seconds() > seconds_of_probe || stop_.stop_requested(); }

  void add(const TimedWorkload& workload, std::size_t place, std::span<const Technique> techniques) {
    std::vector<sim::Disc> discs = discs_of(workload, place);
    std::vector<sim::Ray> rays = rays_of(workload, discs, place);
    const auto& made = workloads_.emplace_back(new Workload{std::move(discs), std::move(rays)});
    for (const Engine engine : {Engine::simd, Engine::plain})
      for (const Technique technique : techniques)
        if (engine == Engine::simd || (record_of(technique).simd && workloads_.size() == 1))
          timed_.push_back({made.get(), probed_candidate(technique), engine});
  }

  /// The first run of a round brings the data into the caches; that of the first round touches memory for the first time.
  void time(Timed& one, int round) {
    for (int i = 0; i < 2; ++i) {
      const sim::ProcessorStopwatch processor;
      const bool counts = round == 0 && i == 0;
      const sim::Outcome outcome =
          sim::run(one.workload->problem, one.candidate, {.count = counts, .engine = one.engine, .stop = stop_});
      if (outcome.stopped) return;
      if (counts) one.counts = as_expected(outcome.counts);
      if (i == 0) continue;
      const double total = std::min(processor.seconds(), outcome.seconds.total());
      one.preparing.push_back(std::min(total, outcome.seconds.order + outcome.seconds.build));
      one.search.push_back(total - one.preparing.back());
    }
  }

  void learn(const Timed& one) {
    if (one.search.empty()) return;
    const CostBreakdown predicted = price(one.counts, built_in_unit_costs(one.engine), one.candidate.technique);
    PhaseRatios& ratios = of(one.engine, one.candidate.technique);
    const CheckSeconds& checks = one.workload->checks;
    ratios.preparing.add(usual(one.preparing) + checks.discs, predicted.order + predicted.build);
    ratios.search.add(usual(one.search) + checks.rays, predicted.total() - predicted.order - predicted.build);
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
  std::vector<std::unique_ptr<const Workload>> workloads_;
  std::vector<Timed> timed_;
  std::array<std::array<PhaseRatios, all_techniques.size()>, 2> ratios_ = {};  ///< by engine
};

/// Whether a file can be made there. Makes its folder.
bool can_write(const std::string& path) {
  if (path.empty()) return false;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  return !failed && access(folder.c_str(), W_OK) == 0;
}

}  // namespace

Calibration probe(const std::stop_token& stop) { return Probe(stop).run(); }

void probe_once(const std::stop_token& stop) {
  const std::string path = probe_path();
  if (stored_calibration() || !can_write(path)) return;
  try {
    const Calibration found = probe(stop);
    if (!stop.stop_requested()) write_calibration(path, found);
  } catch (const std::exception&) {  // no memory, or a full disk: no reason to refuse what was asked
  }
}

}  // namespace detp::validate
