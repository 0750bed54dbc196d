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

struct Replanned {
  const Prediction* candidate = nullptr;
  double seconds = std::numeric_limits<double>::infinity();
  int threads = 1;
  double again = 0;    ///< seconds of a repeated search
  double prepare = 0;  ///< of seconds
  double bytes_touched = 0;

  [[nodiscard]] double judged_seconds() const { return candidate == nullptr ? seconds : seconds * candidate->doubt; }
};

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
  const auto by_closed_form = [&](const Prediction& one) -> Replanned {
    const double ratio = count / basis.rays;
    if (!basis.workload)
      return {&one,
              one.seconds() * ratio,
              one.threads,
              one.time.again() * ratio,
              (one.time.order + one.time.build) * ratio,
              one.counts.bytes_touched};
    if (!now) {
      now = with_disc_radius(*basis.workload, disc_radius);
      now->rays = count;
    }
    const Prediction found = model::assess(*now, one.candidate, basis.options.costs, most_threads);
    return {&one,
            found.seconds(),
            found.threads,
            found.time.again(),
            found.time.order + found.time.build,
            found.counts.bytes_touched};
  };
  const auto by_pilot = [&](const Prediction& one) -> Replanned {
    Counts<double> counts =
        with_bytes_touched(one.counts_at(disc_radius / basis.radius, count), one.candidate, basis.options.costs.engine);
    if (basis.order) counts.sorted = 0;
    const auto fastest = fastest_price(counts, basis.options.costs, one.candidate.technique, most_threads);
    return {&one,
            fastest.time.total(),
            fastest.threads,
            fastest.time.again(),
            fastest.time.order + fastest.time.build,
            counts.bytes_touched};
  };
  Replanned best;
  for (const Prediction& one : basis.candidates) {
    if (!one.counts_at && one.doubtful_seconds() * least_ratio >= best.judged_seconds()) continue;  // it cannot win
    const Replanned found = one.counts_at ? by_pilot(one) : by_closed_form(one);
    if (found.judged_seconds() < best.judged_seconds() || best.candidate == nullptr) best = found;
  }
  Plan made(plan.basis_, best.candidate->candidate);
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
  made.threads_ = best.threads;
  made.predicted_seconds_ = best.seconds;
  made.predicted_seconds_again_ = best.again;
  made.prepare_seconds_ = best.prepare;
  made.peak_bytes_ = bytes_in_memory(count, basis.problem.discs().size(), best.bytes_touched);
  made.predicted_error_ =
      best.candidate->seconds() > 0 ? best.candidate->error * best.seconds / best.candidate->seconds() : 0;
  made.rays_ = count;
  made.rigor_ = plan.rigor_;
  made.planning_seconds_ = watch.seconds();
  return made;
}

}  // namespace detp::validate
