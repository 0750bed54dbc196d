#include <fmt/format.h>

#include "detp/sim/lists/sphere_walk.hpp"
#include "technique.hpp"
#include "walk_index.hpp"

namespace detp::sim {
namespace {

WalkedSpheres spheres_of(const Problem& problem, const SphereCacheParameters& parameters,
                         SphereWalk::ServingSpheres serving) {
  const SphereWalk walk(problem, parameters, serving);
  return {.order = parameters.order,
          .make_walk =
              [walk](std::pmr::memory_resource& memory) { return make_in<ListWalk, SphereWalk>(memory, walk, memory); },
          .lists = lists_of(problem, parameters),
          .what = fmt::format("{} spheres and their lists of rays", SphereWalk::levels(problem, parameters))};
}

}  // namespace

/// Nested spheres with lists of their rays, walked from the outermost inwards, so that no hit is lost.
///
/// A sphere serves a disc if it and all larger spheres contain the disc. From the first sphere that does not contain
/// the disc, all spheres are rebuilt around the disc's centre, each from the list of the next larger sphere, as long as
/// they contain the disc.
std::unique_ptr<Index> prepare_sphere_cache(const Problem& problem, const Parameters& parameters,
                                            const RunOptions& options) {
  const auto& own = std::get<SphereCacheParameters>(parameters);
  return prepare_walk(problem, spheres_of(problem, own, SphereWalk::ServingSpheres::all_that_hold), options);
}

/// The paper's walk (section 2.2), kept for study: searches from the innermost sphere outwards for the first that
/// contains the disc. This sphere may extend beyond larger spheres, so its list may lack rays, and hits are lost.
///
/// Always in double: which hits are lost depends on every ray in a sphere's list, and the lists of the float engine
/// hold a few more rays.
std::unique_ptr<Index> prepare_sphere_cache_published(const Problem& problem, const Parameters& parameters,
                                                      const RunOptions& options) {
  const auto& own = std::get<SphereCacheParameters>(parameters);
  RunOptions plain = options;
  plain.engine = Engine::plain;
  return prepare_walk(problem, spheres_of(problem, own, SphereWalk::ServingSpheres::innermost_that_holds), plain);
}

}  // namespace detp::sim
