#include "fit_all.hpp"

#include <algorithm>

#include "built_in_costs.hpp"
#include "detp/validate/statistics/statistics.hpp"

namespace detp::validate {
namespace {

constexpr std::size_t least_on_one_thread = 10;
constexpr std::size_t least_on_more = 5;

class Fitter {
 public:
  Fitter(const TimedRuns& runs, Calibration& result) : runs_(runs), result_(result) {}

  void run() {
    for (const Engine engine : {Engine::plain, Engine::simd}) {
      result_.of(engine).costs = built_in_unit_costs(engine);
      for (const Technique technique : all_techniques) {
        fit_costs_of(technique, engine);
        fit_threads_of(technique, engine);
      }
    }
    for (const Technique technique : all_techniques)
      if (!record_of(technique).simd) {  // both engines are the same
        result_.plain.costs[technique] = result_.simd.costs[technique];
        result_.plain.costs.threads_of(technique) = result_.simd.costs.threads_of(technique);
      }
    for (const Engine engine : {Engine::plain, Engine::simd})  // always plain
      result_.of(engine).costs[Technique::sphere_cache_published] = result_.plain.costs[Technique::sphere_cache];
    if (!errors_.empty()) result_.left_out_median_error = median(errors_);
    if (!thread_errors_.empty()) result_.threads_left_out_median_error = median(thread_errors_);
    set_relative_errors();
  }

 private:
  void fit_costs_of(Technique technique, Engine engine) {
    const std::vector<TimedRun>& runs = runs_.of(engine, technique).on_one_thread;
    if (runs.size() < least_on_one_thread) return;
    EngineCalibration& result = result_.of(engine);
    const CostFit& fit = result.fits[static_cast<std::size_t>(technique)].emplace(
        fit_costs(runs, technique, built_in_unit_costs(engine)[technique]));
    result.costs[technique] = fit.costs;
    errors_.insert(errors_.end(), fit.left_out_errors.begin(), fit.left_out_errors.end());
  }

  void fit_threads_of(Technique technique, Engine engine) {
    const std::vector<ThreadedRun>& runs = runs_.of(engine, technique).on_more;
    if (runs.size() < least_on_more) return;
    const ThreadFit fit = fit_threads(runs, technique, engine, built_in_unit_costs(engine).threads_of(technique));
    if (fit.left_out_errors.empty()) return;  // too few workloads
    EngineCalibration& result = result_.of(engine);
    result.thread_fits[static_cast<std::size_t>(technique)] = fit;
    result.costs.threads_of(technique) = fit.costs;
    thread_errors_.insert(thread_errors_.end(), fit.left_out_errors.begin(), fit.left_out_errors.end());
  }

  void set_relative_errors() {
    for (const Engine engine : {Engine::plain, Engine::simd})
      for (const Technique technique : all_techniques) {
        const Engine own = record_of(technique).simd ? engine : Engine::simd;
        const auto& fit = result_.of(own).fits[static_cast<std::size_t>(technique)];
        const bool known = fit && !fit->left_out_errors.empty();
        const CalibrationQuality quality{known ? median(fit->left_out_errors) : result_.left_out_median_error,
                                         result_.processor_share};
        result_.of(engine).costs.relative_error_of(technique) = quality.relative_error();
      }
  }

  const TimedRuns& runs_;
  Calibration& result_;
  std::vector<double> errors_;
  std::vector<double> thread_errors_;
};

}  // namespace

void fit_all(const TimedRuns& runs, Calibration& result) { Fitter(runs, result).run(); }

}  // namespace detp::validate
