#include "probe.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>

#include "built_in_costs.hpp"
#include "calibration_file.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/files/file_error.hpp"
#include "detp/sim/technique/technique.hpp"
#include "timed_workloads.hpp"

namespace detp::validate {
namespace {

constexpr double most_seconds_of_probe = 0.2;
constexpr int repeats = 3;

/// What is known of one technique and engine: the sum of ln(measured over predicted seconds).
struct Ratios {
  double sum = 0;
  int count = 0;

  void add(double ratio) { sum += std::log(ratio), ++count; }
  void add(const Ratios& more) { sum += more.sum, count += more.count; }
  [[nodiscard]] double mean() const { return count > 0 ? std::exp(sum / count) : 1; }
};

using RatiosOfEngine = std::array<Ratios, all_techniques.size()>;

class Probe {
 public:
  explicit Probe(const std::stop_token& stop) : stop_(stop) {}

  Calibration run() && {
    const sim::DefaultFloatingPoint mode;
    const std::array workloads{TimedWorkload{sim::Body::cube_faces, 2000, 3000, 0.02},
                               TimedWorkload{sim::Body::cube, 1000, 2000, 0.05}};
    for (std::size_t place = 0; place < workloads.size(); ++place) measure(workloads[place], place);
    Calibration found;
    found.probe = true;
    found.left_out_median_error = probe_error;
    for (const Engine engine : {Engine::simd, Engine::plain}) set(found.of(engine).costs, engine);
    found.seconds = watch_.seconds();
    return found;
  }

 private:
  void measure(const TimedWorkload& workload, std::size_t place) {
    const auto discs = discs_of(workload, place);
    const auto rays = rays_of(workload, discs, place);
    const sim::Problem problem = sim::make_problem(rays, discs);
    for (const Engine engine : {Engine::simd, Engine::plain})
      for (const Technique technique : exact_techniques) {
        if (engine == Engine::plain && !record_of(technique).simd) continue;  // both engines are the same
        if (watch_.seconds() > most_seconds_of_probe || stop_.stop_requested()) return;
        time(problem, default_candidate(technique), engine);
      }
  }

  void time(const sim::Problem& problem, const Candidate& candidate, Engine engine) {
    double least = std::numeric_limits<double>::infinity();
    Counts<double> counts;
    for (int i = 0; i < repeats; ++i) {
      const sim::ProcessorStopwatch processor;
      const sim::Outcome outcome = sim::run(problem, candidate, {.count = i == 0, .engine = engine, .stop = stop_});
      if (outcome.stopped) return;
      if (i == 0) counts = as_expected(outcome.counts);
      least = std::min({least, processor.seconds(), outcome.seconds.total()});
    }
    const double predicted = price(counts, built_in_unit_costs(engine), candidate.technique).total();
    if (least > 0 && predicted > 0) of(engine)[static_cast<std::size_t>(candidate.technique)].add(least / predicted);
  }

  void set(CostTable& costs, Engine engine) {
    Ratios all;
    for (const Ratios& one : of(engine)) all.add(one);
    costs = built_in_unit_costs(engine);
    for (const Technique technique : all_techniques) {
      const Engine own = record_of(technique).simd ? engine : Engine::simd;
      const Ratios& measured = of(own)[static_cast<std::size_t>(technique)];
      const double factor = measured.count > 0 ? measured.mean() : all.mean();
      for (const UnitCostTerm& term : unit_cost_terms) costs[technique].*term.cost *= factor;
      costs.threads_of(technique).start *= factor;
      costs.relative_error_of(technique) = CalibrationQuality{probe_error, 1}.relative_error();
    }
  }

  [[nodiscard]] RatiosOfEngine& of(Engine engine) { return ratios_[static_cast<std::size_t>(engine)]; }

  const std::stop_token& stop_;
  sim::Stopwatch watch_;
  std::array<RatiosOfEngine, 2> ratios_ = {};  ///< by engine
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
  const Calibration found = probe(stop);
  if (stop.stop_requested()) return;
  try {
    write_calibration(path, found);
  } catch (const sim::FileError&) {  // the disk is full, for one
  }
}

}  // namespace detp::validate
