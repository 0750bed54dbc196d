#include "pilot_counts.hpp"

#include <algorithm>
#include <cmath>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/model/vocabulary/ray_blocks.hpp"

namespace detp::sim::stream {
namespace {

/// A number of lists that hold a ray, summed over the blocks of rays, and what it depends on.
struct ListsWithRays {
  double count;     ///< with the pilot's radius and rays
  double of;        ///< number of lists of one block, empty ones included
  double rays_in;   ///< rays in all of these lists
  double new_rays;  ///< rays in all of these lists, with another radius and number of rays
};

/// The count with other rays. The spread of the lists' shares of the rays is found by bisection.
double count_with(const ListsWithRays& lists, double rays, const RayBlocks& blocks, double new_rays,
                  const RayBlocks& new_blocks) {
  if (!(lists.count > 0 && lists.of > 0)) return 0;
  const double share = lists.rays_in / (rays * lists.of);
  double low = std::log(1e-5);  // hardly any spread
  double high = std::log(1e5);  // nearly all rays in a few lists
  const bool all_have_some = lists.count > (1 - 1e-6) * blocks.count() * lists.of;
  const int halvings = all_have_some ? 0 : 12;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (blocks.with_any(share, std::exp(middle)) * lists.of > lists.count ? low : high) = middle;
  }
  const double spread = std::exp(low);
  const double with_any = new_blocks.with_any(lists.new_rays / (new_rays * lists.of), spread);
  const double all = new_blocks.count() * lists.of;
  return std::min(all, lists.count * with_any / blocks.with_any(share, spread));
}

}  // namespace

Counts<double> PilotCounts::at(double radius_ratio, double rays) const {
  require_positive("ratio of the radii", radius_ratio);
  require_count("number of rays", rays, 1, 1e18);
  if (radius_ratio == 1 && rays == counts.loaded) return counts;
  const double more = rays / counts.loaded;
  const double discs = counts.placements;
  Counts<double> changed = counts;
  changed.loaded = rays;
  changed.segments = more * counts.segments;
  changed.cull_tests = more * (counts.cull_tests + cull_tests.at(radius_ratio));
  changed.listed = more * (counts.listed + listed.at(radius_ratio));
  changed.disc_tests = more * (counts.disc_tests + disc_tests.at(radius_ratio));
  changed.hits = more * counts.hits * radius_ratio * radius_ratio;
  changed.doubtful = more * counts.doubtful * radius_ratio;
  const RayBlocks blocks = ray_blocks(counts.loaded, discs, Engine::simd);
  const RayBlocks new_blocks = ray_blocks(rays, discs, Engine::simd);
  changed.culls =
      count_with({counts.culls, nodes, counts.cull_tests, changed.cull_tests}, counts.loaded, blocks, rays, new_blocks);
  changed.visits = count_with({counts.visits, discs, counts.disc_tests, changed.disc_tests}, counts.loaded, blocks,
                              rays, new_blocks);
  return changed;
}

}  // namespace detp::sim::stream
