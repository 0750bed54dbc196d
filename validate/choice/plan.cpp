#include "plan.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "choice.hpp"
#include "comparison.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/technique/piloted_discs.hpp"
#include "detp/sim/technique/technique.hpp"
#include "plan_basis.hpp"

namespace detp::validate {
namespace {

/// Root mean square of the radii of some discs; exactly their radius if it is the same for these.
double typical_radius(std::span<const sim::Disc> discs) {
  constexpr std::size_t most = 256;
  const std::size_t step = (discs.size() - 1) / most + 1;
  double squares = 0;
  double count = 0;
  bool same = true;
  for (std::size_t i = 0; i < discs.size(); i += step, ++count) {
    squares += discs[i].radius * discs[i].radius;
    same = same && discs[i].radius == discs.front().radius;
  }
  return same ? discs.front().radius : std::sqrt(squares / count);
}

/// A view's rays, spread evenly, at most so many that a pilot can draw all its samples from them.
std::vector<sim::Ray> shown_rays(const sim::RaysView& view, int threads) {
  constexpr std::size_t most = std::size_t{1} << 18;
  std::vector<sim::Ray> rays(std::min(view.count, most));
  if (view.count <= most) {
    sim::read_rays(view, 0, rays, threads);
    return rays;
  }
  const std::vector<std::size_t> drawn = sim::stratified_sample(view.count, most, 0, sim::Stream::pilot);
  for (std::size_t i = 0; i < drawn.size(); ++i) rays[i] = sim::read_ray(view, drawn[i]);
  return rays;
}

/// Throws as sim::make_problem does for malformed rays, with their numbers.
void check_all(const sim::Problem& problem, const sim::RaysView& view, const PlanOptions& options) {
  constexpr std::size_t at_once = std::size_t{1} << 17;
  std::vector<sim::Ray> piece;
  std::vector<double> further;
  for (std::size_t first = 0; first < view.count; first += piece.size()) {
    piece.resize(std::min(at_once, view.count - first));
    sim::read_rays(view, first, piece, options.threads);
    sim::Problem with_rays = problem;
    sim::PathRays rays(piece);
    sim::read_further_powers(view, first, piece.size(), further);
    rays.further = {further, view.further_powers.size()};
    sim::set_rays(with_rays, rays, options.threads, first);
  }
}

}  // namespace

double Plan::peak_bytes() const {
  return sizeof(sim::Ray) * rays_ + sizeof(sim::Disc) * static_cast<double>(basis_->problem.discs().size()) +
         predicted_.bytes_touched;
}

bool Plan::is_built() const { return searcher_->is_built(); }
void Plan::build(const std::stop_token& stop) const { static_cast<void>(searcher_->get(stop)); }
const sim::Searcher& Plan::searcher() const { return searcher_->get(); }

std::unique_ptr<sim::Index> build_index(const sim::Problem& problem, const Candidate& candidate,
                                        const std::optional<sim::DiscOrder>& order, const sim::RunOptions& options) {
  if (order && candidate.technique == Technique::box_tree)
    return order->prepare(problem, std::get<BoxTreeParameters>(candidate.parameters), options);
  return sim::prepare(problem, candidate, options);
}

/// Makes the plan of some discs and rays.
class Plan::Planner {
 public:
  /// `rays` are some or all of those of the view, unless it is null.
  Planner(std::span<const sim::Disc> discs, std::shared_ptr<const std::vector<sim::Disc>> own_discs,
          std::span<const sim::Ray> rays, const PlanOptions& options, const sim::RaysView* view = nullptr,
          double reading = 0)
      : options_(options),
        rays_(rays),
        view_(view),
        reading_(reading),
        building_{.engine = options.costs.engine, .stop = options.stop, .threads = options.threads} {
    require_count("number of threads", options.threads, 0, sim::most_threads);
    if (rays.empty()) throw std::invalid_argument("a plan needs at least one ray, to see where the rays are");
    const double count = options.rays.value_or(static_cast<double>(view != nullptr ? view->count : rays.size()));
    require_count("number of rays", count, 1, 1e18);
    report("checking the discs", 0, 0.1);
    sim::Problem problem = sim::searched_problem(discs, options.farthest, options.front_facing, options.stop);
    const double radius = typical_radius(problem.discs());
    basis_ = std::make_shared<Basis>(Basis{.options = options,
                                           .problem = std::move(problem),
                                           .radius = radius,
                                           .rays = count,
                                           .own_discs = std::move(own_discs)});
    basis_->options.stop = {};
    basis_->options.progress = {};
  }

  Plan run() {
    Question question{.problem = &basis_->problem,
                      .rays = rays_,
                      .ray_count = basis_->rays,
                      .effects = options_.effects,
                      .purpose = options_.once ? Purpose::one_search : Purpose::replans,
                      .threads = options_.threads,
                      .stop = options_.stop};
    const Rigor rigor = reachable_rigor(question, options_.costs);
    const sim::Stopwatch watch;
    report(rigor == Rigor::pilot ? "sorting the discs, and a pilot" : "measuring discs and rays", 0.1, 0.6);
    Choice choice = with_all_rays_checked([&] {
      if (rigor == Rigor::estimate) question.workload = basis_->workload = evidence(question, basis_->rays);
      return choose(question, options_.costs);
    });
    basis_->candidates = choice.candidates;
    basis_->options.costs = costs_for(question, options_.costs);
    seconds_ = watch.seconds() - choice.sort_seconds;
    report("building the index", 0.6, 1);
    if (choice.discs) basis_->order = choice.discs->order();
    const Candidate& best = choice.best().candidate;
    if (best.technique != Technique::box_tree || choice.discs)
      return planned(rigor, build_choice(choice, basis_->problem, building_));
    basis_->order.emplace(basis_->problem, building_);  // sorted here, so that replans know it
    return planned(rigor, build_index(basis_->problem, best, basis_->order, building_));
  }

 private:
  /// The shares are guesses; they depend on machine and scene.
  void report(const char* what, double from, double to) const {
    if (options_.progress) options_.progress({what, from, to});
    sim::StopCheck(options_.stop, "planning").now();
  }

  /// Returns look(), which sees some of the rays. If one of these is malformed, throws with its number among all rays.
  template <class Look>
  std::invoke_result_t<Look> with_all_rays_checked(const Look& look) const {
    try {
      return look();
    } catch (const std::invalid_argument&) {
      if (view_ != nullptr)
        check_all(basis_->problem, *view_, options_);
      else
        static_cast<void>(
            sim::make_problem(rays_, basis_->problem.discs(), options_.front_facing, options_.threads, options_.stop));
      throw;
    }
  }

  Plan planned(Rigor rigor, std::unique_ptr<sim::Index> index) {
    const Prediction& best = basis_->candidates.front();
    Plan made;
    made.candidate_ = best.candidate;
    made.basis_ = basis_;
    made.searcher_ = std::make_shared<LateSearcher>(sim::Searcher(basis_->problem, std::move(index)));
    made.predicted_ = Predicted(best);
    const double reading = reading_ * basis_->rays / static_cast<double>(rays_.size());
    made.predicted_.seconds += reading;
    made.predicted_.again += reading;
    made.rays_ = basis_->rays;
    made.planning_seconds_ = seconds_;
    made.rigor_ = rigor;
    return made;
  }

  const PlanOptions& options_;
  std::span<const sim::Ray> rays_;
  const sim::RaysView* view_;
  double reading_;  ///< seconds for reading the rays from a view, which each search does again
  sim::RunOptions building_;
  std::shared_ptr<Basis> basis_;
  double seconds_ = 0;  ///< for choosing
};

Plan plan(std::span<const sim::Disc> discs, std::span<const sim::Ray> rays, const PlanOptions& options) {
  const sim::DefaultFloatingPoint mode;
  return Plan::Planner(discs, nullptr, rays, options).run();
}

Plan plan(const sim::DiscsView& discs, const sim::RaysView& rays, const PlanOptions& options) {
  const sim::DefaultFloatingPoint mode;
  const auto own_discs = std::make_shared<const std::vector<sim::Disc>>(sim::read_discs(discs));
  const sim::Stopwatch watch;
  const std::vector<sim::Ray> shown = shown_rays(rays, options.threads);
  return Plan::Planner(*own_discs, own_discs, shown, options, &rays, watch.seconds()).run();
}

}  // namespace detp::validate
