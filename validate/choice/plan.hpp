#pragma once

#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "detp/sim/technique/searcher.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"

/// Plans a search once, and executes it again and again.
namespace detp::validate {

struct PlanOptions {
  CostTable costs = built_in_unit_costs();  ///< seconds; measure those of this machine with validate::calibrate
  std::optional<double> rays = {};          ///< number of rays in each search; default: as many as are shown to `plan`
  std::optional<double> farthest = {};      ///< as for sim::Searcher
  bool front_facing = false;
  int threads = 1;  ///< most threads, for building and for each search; 0: all cores
  std::stop_token stop = {};
};

/// The choice for some discs, and its index. Const: many threads may execute a plan at once, each with its own scratch.
class Plan {
 public:
  [[nodiscard]] const Candidate& candidate() const { return candidate_; }
  /// Number of threads of a search, at most PlanOptions::threads.
  [[nodiscard]] int threads() const { return threads_; }
  /// Predicted time of one search on threads(), sorting and building included.
  [[nodiscard]] double predicted_seconds() const { return predicted_seconds_; }
  /// Standard error of the predicted time, because the pilot has only a sample of rays and subtrees. The error of the
  /// unit costs comes in addition.
  [[nodiscard]] double predicted_error() const { return predicted_error_; }
  [[nodiscard]] double planning_seconds() const { return planning_seconds_; }  ///< without sorting and building
  /// Searches the index; see execute.
  [[nodiscard]] const sim::Searcher& searcher() const { return searcher_; }

 private:
  friend Plan plan(std::span<const sim::Disc>, std::span<const sim::Ray>, const PlanOptions&);
  friend Plan plan(const sim::DiscsView&, const sim::RaysView&, const PlanOptions&);
  Plan(Candidate candidate, sim::Searcher searcher) : candidate_(candidate), searcher_(std::move(searcher)) {}

  Candidate candidate_;
  std::shared_ptr<const std::vector<sim::Disc>> own_discs_;  ///< null if the discs are borrowed
  sim::Searcher searcher_;
  int threads_ = 1;
  double predicted_seconds_ = 0;
  double predicted_error_ = 0;
  double planning_seconds_ = 0;
};

/// Chooses technique, parameters and number of threads by a pilot (choose_by_pilot), and builds the index. If the rays
/// may start too far away for float kernels, or if the costs are those of the plain engine, chooses by closed forms; then
/// the costs' engine searches. `rays` are some or all of the rays that will be
/// searched. Borrows the discs, which must outlive the plan.
///
/// Throws as make_problem and run do, and std::invalid_argument if there are no rays; sim::Stopped on a stop request.
[[nodiscard]] Plan plan(std::span<const sim::Disc> discs, std::span<const sim::Ray> rays,
                        const PlanOptions& options = {});

/// The same for views. Copies the discs.
[[nodiscard]] Plan plan(const sim::DiscsView& discs, const sim::RaysView& rays, const PlanOptions& options = {});

/// Finds the hits of the rays: a span or a view. Returns scratch.outcome, as sim::Searcher::search does, and throws as it
/// does. Without options, runs on plan.threads() threads.
template <class Rays>
const sim::Outcome& execute(const Plan& plan, const Rays& rays, sim::SearchScratch& scratch,
                            const sim::RunOptions& options) {
  return plan.searcher().search(rays, scratch, options);
}
template <class Rays>
const sim::Outcome& execute(const Plan& plan, const Rays& rays, sim::SearchScratch& scratch) {
  return execute(plan, rays, scratch, {.threads = plan.threads()});
}

}  // namespace detp::validate
