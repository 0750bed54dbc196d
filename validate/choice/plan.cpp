#include "plan.hpp"

#include <stdexcept>
#include <utility>

#include "detp/model/rank/choose.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/technique/piloted_discs.hpp"
#include "detp/sim/technique/registry.hpp"
#include "measure.hpp"
#include "pilot.hpp"

namespace detp::validate {

Plan plan(std::span<const sim::Disc> discs, std::span<const sim::Ray> rays, const PlanOptions& options) {
  if (rays.empty()) throw std::invalid_argument("a plan needs at least one ray, to see where the rays are");
  sim::Problem problem = sim::searched_problem(discs, options.farthest, options.front_facing, options.stop);
  const sim::RunOptions building{.engine = options.costs.engine, .stop = options.stop, .threads = options.threads};
  const double count = options.rays.value_or(static_cast<double>(rays.size()));
  const sim::Stopwatch watch;
  if (!sim::PilotedDiscs::can_pilot(problem) || options.costs.engine == Engine::plain) {
    Workload workload =
        measure(sim::make_problem(rays, discs, options.front_facing, options.threads, options.stop), {}, options.stop);
    workload.rays = count;
    const model::Ranked first =
        model::rank(workload, options.costs, {.threads = sim::useful_threads(options.threads), .stop = options.stop})
            .front();
    const double planning = watch.seconds();
    auto index = sim::prepare(problem, first.candidate, building);
    Plan made(first.candidate, sim::Searcher(std::move(problem), std::move(index)));
    made.threads_ = first.threads;
    made.predicted_seconds_ = first.time.total();
    made.planning_seconds_ = planning;
    return made;
  }
  PilotChoice choice;
  try {
    choice = choose_by_pilot(problem, pilot_sample(rays, discs.size()), count, options.costs,
                             {.threads = options.threads, .stop = options.stop});
  } catch (const std::invalid_argument&) {  // names a malformed ray by its number in the sample
    static_cast<void>(sim::make_problem(rays, discs, options.front_facing, options.threads, options.stop));
    throw;
  }
  const double planning = watch.seconds() - choice.sort_seconds;
  auto index = build_choice(choice, problem, building);
  Plan made(choice.choice().candidate, sim::Searcher(std::move(problem), std::move(index)));
  made.threads_ = choice.choice().threads;
  made.predicted_seconds_ = choice.choice().time.total();
  made.predicted_error_ = choice.choice().error;
  made.planning_seconds_ = planning;
  return made;
}

Plan plan(const sim::DiscsView& discs, const sim::RaysView& rays, const PlanOptions& options) {
  const auto own_discs = std::make_shared<const std::vector<sim::Disc>>(sim::read_discs(discs));
  std::vector<sim::Ray> copied;
  sim::read_rays(rays, copied);
  Plan made = plan(*own_discs, copied, options);
  made.own_discs_ = own_discs;
  return made;
}

}  // namespace detp::validate
