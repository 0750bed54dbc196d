#include "cost_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "detp/validate/statistics/non_negative_fit.hpp"
#include "detp/validate/statistics/statistics.hpp"

namespace detp::validate {
namespace {

constexpr std::size_t thread_unknowns = 3;  // the members of ThreadCosts, in their order

class ThreadFitter {
 public:
  ThreadFitter(Technique technique, Engine engine, const std::optional<ThreadCosts>& usual)
      : technique_(technique), engine_(engine), usual_(usual) {}

  [[nodiscard]] ThreadCosts fit(std::span<const ThreadedRun> runs) const {
    std::vector<double> rows;
    std::vector<double> right;
    for (const ThreadedRun& run : runs) {
      const Pieces pieces = pieces_of(run.counts, technique_, engine_);
      const double preparing = run.one_preparing / busy_threads(pieces.preparing, run.threads);
      const double search = (run.one_seconds - run.one_preparing) / busy_threads(pieces.search, run.threads);
      const double more_preparing = run.one_preparing - preparing;  // if nothing ran in parallel
      const double more_search = run.one_seconds - run.one_preparing - search;
      const auto add = [&](double measured, double least, double p, double s, double a) {
        for (const double one : {p, s, a}) rows.push_back(one / measured);
        right.push_back((measured - least) / measured);
      };
      const bool divided = more_preparing > 0 || more_search > 0;
      add(run.seconds, preparing + search, more_preparing, more_search, divided ? run.threads - 1 : 0);
      if (run.preparing > 0 && more_preparing > 0) add(run.preparing, preparing, more_preparing, 0, 0);
    }
    std::array<bool, thread_unknowns> divided{};
    for (std::size_t i = 0; i < rows.size(); ++i) divided[i % thread_unknowns] |= rows[i] > 0;
    if (usual_) add_usual(rows, right);
    const std::vector<double> x = non_negative_fit(rows, thread_unknowns, right);
    const auto share = [&](std::size_t column) { return divided[column] ? std::min(1.0, x[column]) : 1.0; };
    return {.serial_preparing = share(0), .serial_search = share(1), .start = x[2]};
  }

  [[nodiscard]] std::vector<double> errors(std::span<const ThreadedRun> runs, const ThreadCosts& costs) const {
    std::vector<double> all;
    for (const ThreadedRun& run : runs) {
      const CostBreakdown one{.build = run.one_preparing, .intersect = run.one_seconds - run.one_preparing};
      const Pieces pieces = pieces_of(run.counts, technique_, engine_);
      all.push_back(std::abs(on_threads(one, pieces, costs, run.threads).total() / run.seconds - 1));
    }
    return all;
  }

 private:
  void add_usual(std::vector<double>& rows, std::vector<double>& right) const {
    const double weight = std::sqrt(weight_of_usual);
    const std::array usual{usual_->serial_preparing, usual_->serial_search, usual_->start};
    for (std::size_t i = 0; i < thread_unknowns; ++i) {
      const double scale = i == 2 ? usual_->start : 1;
      if (!(scale > 0)) continue;
      for (std::size_t j = 0; j < thread_unknowns; ++j) rows.push_back(i == j ? weight / scale : 0);
      right.push_back(weight * usual[i] / scale);
    }
  }

  Technique technique_;
  Engine engine_;
  std::optional<ThreadCosts> usual_;
};

}  // namespace

ThreadFit fit_threads(std::span<const ThreadedRun> runs, Technique technique, Engine engine,
                      const std::optional<ThreadCosts>& usual) {
  constexpr std::size_t least_runs = 5;
  if (runs.size() < least_runs)
    throw std::invalid_argument(fmt::format("a fit of the costs of threads takes at least {} runs of {} (got {})",
                                            least_runs, name(technique), runs.size()));
  for (const ThreadedRun& run : runs) {
    require_positive("seconds of a run", run.seconds);
    require_positive("seconds of a run on one thread", run.one_seconds);
    require_count("number of threads of a run", run.threads, 2, 1e6);
  }
  const ThreadFitter fitter(technique, engine, usual);
  ThreadFit result{.costs = fitter.fit(runs), .runs = runs.size()};
  result.median_error = median(fitter.errors(runs, result.costs));
  result.left_out_errors =
      errors_left_out(runs, [&](std::span<const ThreadedRun> others, std::span<const ThreadedRun> some) {
        return fitter.errors(some, fitter.fit(others));
      });
  return result;
}

}  // namespace detp::validate
