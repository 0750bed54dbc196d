#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "detp/model/rank/choose.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/search/soundness.hpp"
#include "plan_basis.hpp"

namespace detp::validate {
namespace {

/// The discs with another radius.
std::vector<sim::Disc> resized(std::span<const sim::Disc> discs, double radius, const std::stop_token& stop) {
  sim::StopCheck check(stop, "changing the radius of the discs");
  std::vector<sim::Disc> changed;
  changed.reserve(discs.size());
  sim::for_each_checked(discs, check, [&](sim::Disc disc) {
    disc.radius = radius;
    changed.push_back(disc);
  });
  return changed;
}

}  // namespace

double least_time_ratio(double radius_ratio, double rays_ratio) {
  const double least = std::min(1.0, radius_ratio);
  return least * least * least * std::min(1.0, rays_ratio);
}

Plan replan(const Plan& plan, double disc_radius, std::optional<double> rays) {
  const sim::DefaultFloatingPoint mode;
  const sim::Stopwatch watch;
  const Plan::Basis& basis = *plan.basis_;
  require_positive("disc radius", disc_radius);
  if (disc_radius < sim::least_radius || disc_radius > sim::largest_coordinate)
    throw std::invalid_argument(
        fmt::format("disc radius must be from 1e-100 to 1e100, or its square overflows (got {})", disc_radius));
  const double count = rays.value_or(plan.rays_);
  require_count("number of rays", count, 1, 1e18);
  const int most_threads = sim::useful_threads(basis.options.threads);
  const double least_ratio = least_time_ratio(disc_radius / basis.radius, count / basis.rays);
  std::optional<Workload> now;
  const auto by_closed_form = [&](const Prediction& one) {
    if (!basis.workload) {
      const double ratio = count / basis.rays;
      Plan::Predicted scaled(one);
      for (double* seconds : {&scaled.seconds, &scaled.again, &scaled.prepare}) *seconds *= ratio;
      return scaled;
    }
    if (!now) {
      now = with_disc_radius(*basis.workload, disc_radius);
      now->rays = count;
    }
    return Plan::Predicted(model::assess(*now, one.candidate, basis.options.costs, most_threads));
  };
  const auto by_pilot = [&](const Prediction& one) {
    Prediction found{.counts = with_bytes_touched(one.counts_at(disc_radius / basis.radius, count), one.candidate,
                                                  basis.options.costs.engine)};
    if (basis.order) found.counts.sorted = 0;
    const auto [threads, time] =
        fastest_price(found.counts, basis.options.costs, one.candidate.technique, most_threads);
    found.threads = threads;
    found.time = time;
    return Plan::Predicted(found);
  };
  Plan made;
  const Prediction* best = nullptr;
  double least = std::numeric_limits<double>::infinity();  // seconds, doubted
  for (const Prediction& one : basis.candidates) {
    if (!one.counts_at && one.doubtful_seconds() * least_ratio >= least) continue;  // it cannot win
    const Plan::Predicted found = one.counts_at ? by_pilot(one) : by_closed_form(one);
    if (best != nullptr && !(found.seconds * one.doubt < least)) continue;
    best = &one;
    least = found.seconds * one.doubt;
    made.predicted_ = found;
  }
  made.predicted_.error = best->seconds() > 0 ? best->error * made.predicted_.seconds / best->seconds() : 0;
  made.candidate_ = best->candidate;
  made.basis_ = plan.basis_;
  made.searcher_ =
      std::make_shared<LateSearcher>([shared = plan.basis_, candidate = made.candidate_, disc_radius,
                                      discs = std::vector<sim::Disc>()](const std::stop_token& stop) mutable {
        discs = resized(shared->problem.discs(), disc_radius, stop);
        const PlanOptions& options = shared->options;
        sim::Problem problem = sim::searched_problem(discs, options.farthest, options.front_facing, stop);
        const sim::RunOptions building{.engine = options.costs.engine, .stop = stop, .threads = options.threads};
        auto index = build_index(problem, candidate, shared->order, building);
        return sim::Searcher(std::move(problem), std::move(index));
      });
  made.rays_ = count;
  made.rigor_ = plan.rigor_;
  made.planning_seconds_ = watch.seconds();
  return made;
}

}  // namespace detp::validate
