#include <fmt/format.h>

#include "detp/sim/stream/search.hpp"
#include "detp/sim/stream/walk_search.hpp"
#include "list_memory.hpp"
#include "sphere_walk.hpp"
#include "techniques.hpp"
#include "walk_search.hpp"

namespace detp::sim {
namespace {

void search(const Problem& problem, const SphereCacheParameters& parameters, SphereWalk::Serving serving, bool plain,
            const RunOptions& options, Outcome& outcome) {
  need_memory(fmt::format("{} spheres and their lists of rays", SphereWalk::levels(problem, parameters)),
              walk_bytes(problem, options, lists_of(problem, parameters), plain), problem, outcome);
  Stopwatch watch;
  std::vector<std::uint32_t> order = along_curve(problem.discs, parameters.order, options.stop);
  outcome.seconds.order = watch.lap();
  const std::size_t sorted = parameters.order == SampleOrder::none ? 0 : order.size();
  if (plain) {
    SphereWalk walk(problem, parameters, serving);
    search_along(walk, problem, order, options, outcome);
  } else {
    const auto make_walk = [&] { return std::make_unique<SphereWalk>(problem, parameters, serving); };
    stream::search_walk(problem, std::move(order), make_walk, lists_of(problem, parameters).room(), options, outcome);
  }
  if (options.count) outcome.counts.sorted = sorted;
  outcome.seconds.search = watch.lap();
}

}  // namespace

void run_sphere_cache(const Problem& problem, const SphereCacheParameters& parameters, const RunOptions& options,
                      Outcome& outcome) {
  const bool plain = options.plain || !stream::can_search(problem);
  search(problem, parameters, SphereWalk::Serving::all_that_hold, plain, options, outcome);
}

/// Always plain: which hits it loses depends on every ray that a sphere lists, and floats list a few more.
void run_sphere_cache_published(const Problem& problem, const SphereCacheParameters& parameters,
                                const RunOptions& options, Outcome& outcome) {
  search(problem, parameters, SphereWalk::Serving::innermost_that_holds, true, options, outcome);
}

}  // namespace detp::sim
