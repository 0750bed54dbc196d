#pragma once

#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "detp/sim/base/phase.hpp"
#include "detp/sim/effects/observe.hpp"
#include "detp/sim/technique/searcher.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"

/// Plans a search once, and executes it again and again.
namespace detp::validate {

class LateSearcher;

struct PlanOptions {
  /// seconds, of another machine; those of this one: stored_unit_costs() or calibrate().simd
  CostTable costs = built_in_unit_costs();
  std::optional<double> rays = {};      ///< number of rays in each search; default: as many as are shown to `plan`
  std::optional<double> farthest = {};  ///< as for sim::Searcher
  bool front_facing = false;
  /// that closed forms take into account, in plans and replans
  sim::EffectSelection effects = {};
  /// most threads, for building and for each search; 0: all threads of the caller's oneTBB arena, outside of one all
  /// cores. With as many threads as the caller's arena has, the work runs in that arena.
  int threads = 1;
  /// The plan is executed once or twice: a short search takes the usual shape of a box tree, as in `detp run`, because a pilot
  /// would take longer than it saves; predicted_seconds are then a rough guess.
  bool once = false;
  std::stop_token stop = {};
  /// Called at the beginning of each phase. It cancels the plan if it requests a stop of the source of `stop`.
  sim::ReportPhase progress = {};
};

/// The choice for some discs, and its index. Const: many threads may execute a plan at once, each with its own scratch.
/// Copies share the index.
class Plan {
 public:
  [[nodiscard]] const Candidate& candidate() const { return candidate_; }
  /// Number of threads of a search, at most PlanOptions::threads.
  [[nodiscard]] int threads() const { return predicted_.threads; }
  /// Predicted time of one search on threads(). Includes building, and also sorting, unless the discs' order is known.
  [[nodiscard]] double predicted_seconds() const { return predicted_.seconds; }
  /// The same of a repeated search, whose memory (sim::SearchScratch) is that of an earlier one.
  [[nodiscard]] double predicted_seconds_again() const { return predicted_.again; }
  /// Of predicted_seconds, sorting the discs and building the index.
  [[nodiscard]] double prepare_seconds() const { return predicted_.prepare; }
  /// Predicted memory of rays, discs and a first search of them, bytes.
  [[nodiscard]] double peak_bytes() const;
  /// Standard error of the predicted time: because the pilot has only a sample of rays and subtrees, and because of the unit
  /// costs (CostTable::relative_errors). After `replan`, that of the extrapolation comes in addition.
  [[nodiscard]] double predicted_error() const { return predicted_.error; }
  [[nodiscard]] double planning_seconds() const { return planning_seconds_; }  ///< without sorting and building
  [[nodiscard]] Rigor rigor() const { return rigor_; }                         ///< reached

  [[nodiscard]] bool is_built() const;
  /// Builds the index, unless it is built. `execute` calls it. Throws as sim::prepare, sim::Stopped on a stop request.
  void build(const std::stop_token& stop = {}) const;
  /// Searches the index; see execute. Builds it first, if necessary.
  [[nodiscard]] const sim::Searcher& searcher() const;

 private:
  friend Plan plan(std::span<const sim::Disc>, std::span<const sim::Ray>, const PlanOptions&);
  friend Plan plan(const sim::DiscsView&, const sim::RaysView&, const PlanOptions&);
  friend Plan replan(const Plan&, double, std::optional<double>);
  struct Basis;
  class Planner;
  Plan() = default;
  /// Of one search.
  struct Predicted {
    Predicted() = default;
    explicit Predicted(const Prediction& one)
        : threads(one.threads),
          seconds(one.seconds()),
          again(one.time.again()),
          prepare(one.time.order + one.time.build),
          bytes_touched(one.counts.bytes_touched),
          error(one.error) {}

    int threads = 1;
    double seconds = 0;
    double again = 0;    ///< seconds of a repeated search
    double prepare = 0;  ///< of seconds
    double bytes_touched = 0;
    double error = 0;  ///< of seconds
  };

  Candidate candidate_;
  std::shared_ptr<const Basis> basis_;
  std::shared_ptr<LateSearcher> searcher_;
  Predicted predicted_ = {};
  double rays_ = 0;  ///< number of rays in each search
  double planning_seconds_ = 0;
  Rigor rigor_ = Rigor::estimate;
};

/// Chooses technique, parameters and number of threads (choose), and builds the index: by a pilot. If the rays
/// may start too far away for float kernels, or if the costs are those of the plain engine, chooses by closed forms; then
/// the costs' engine searches. `rays` are some or all of the rays that will be searched. Borrows the discs, which must
/// outlive the plan and its replans.
///
/// Throws as make_problem and run do, and std::invalid_argument if there are no rays; sim::Stopped on a stop request.
[[nodiscard]] Plan plan(std::span<const sim::Disc> discs, std::span<const sim::Ray> rays,
                        const PlanOptions& options = {});

/// The same for views. Copies the discs, and for the time of planning at most 2¹⁸ of the rays, spread evenly: a pilot draws its
/// samples from these.
[[nodiscard]] Plan plan(const sim::DiscsView& discs, const sim::RaysView& rays, const PlanOptions& options = {});

/// A plan for the same samples with discs of another radius, and with `rays` rays in each search (default: as before), for
/// progressive estimation. Finds the same hits as a new plan with this radius would.
///
/// Takes microseconds, however many discs there are: nothing is measured, culled or sorted. The counts of the candidates
/// that the pilot had tried are extrapolated from the first plan's radius and rays (sim::stream::PilotCounts::at), priced,
/// and compared again; replans of replans do not add errors. Techniques that the pilot ruled out stay ruled out. A
/// candidate that no pilot counted is compared by its closed form. Plan again if the radius
/// differs by more than a factor of four, or if rays come from elsewhere.
///
/// The index is not built here, but by the first `execute` (or by Plan::build): the discs are copied and given their
/// radius, 56 bytes each; a box tree gets new boxes and a new shape along the curve on which the first plan had sorted the
/// discs. predicted_seconds includes this, without sorting. Every disc gets the same radius, even if the first plan had
/// discs of different radii.
///
/// Throws std::invalid_argument for a radius out of 1e-100 … 1e100 and for a number of rays out of 1 … 1e18.
[[nodiscard]] Plan replan(const Plan& plan, double disc_radius, std::optional<double> rays = {});

/// Finds the hits of the rays: a span or a view. Builds the index first, if necessary. Returns scratch.outcome, as
/// sim::Searcher::search does, and throws as it does; sim::Stopped if a stop is requested while the index is built.
/// RunOptions::progress is called during the search; if it requests a stop, the outcome is partial. Without options, runs
/// on plan.threads() threads.
template <class Rays>
const sim::Outcome& execute(const Plan& plan, const Rays& rays, sim::SearchScratch& scratch,
                            const sim::RunOptions& options) {
  plan.build(options.stop);
  return plan.searcher().search(rays, scratch, options);
}
template <class Rays>
const sim::Outcome& execute(const Plan& plan, const Rays& rays, sim::SearchScratch& scratch) {
  return execute(plan, rays, scratch, {.threads = plan.threads()});
}

}  // namespace detp::validate
