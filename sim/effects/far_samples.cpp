#include <algorithm>
#include <numeric>

#include "all_effects.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/random.hpp"
#include "far_discs.hpp"
#include "paths_inside.hpp"
#include "sample_dimension.hpp"
#include "sample_extent.hpp"

namespace detp::sim {
namespace {

/// The discs near the centre as a set of samples of their own.
CentralSamples samples_near(const FarDiscs& found, const EffectSample& sample) {
  StopCheck check(sample.stop, "measuring the samples");
  std::vector<Disc> near;
  Box box;
  for_each_checked(sample.problem.discs(), check, [&](const Disc& disc) {
    if (!found.is_near(disc)) return;
    near.push_back(disc);
    box.include(disc.centre);
  });
  const DiscRadii& radii = sample.problem.radii();
  const glm::dvec3 size = box.size();
  const auto counted = stratified_sample(near.size(), sample.discs().discs.size(), 1, Stream::evidence);
  const double dimension =
      sample_dimension(curve_sample(near, counted, sample.problem.enclosing(), sample.stop).keys).value;
  CentralSamples central{.samples = static_cast<double>(near.size()),
                         .sphere_radius = glm::length(size) / 2 + radii.largest,
                         .box = {size.x, size.y, size.z},
                         .dimension = surface_samples.threshold.passed(dimension) ? dimension : 3};
  if (!(box.longest_side() > 0)) central.box.fill(2 * radii.rms);
  central.sample_extent = extent_on_surfaces({.box = central.box, .dimension = central.dimension}, sample.surface.area);
  if (sample.problem.segments()) {
    const PathsInside paths = paths_inside(sample.problem, sample.rays(), box, radii.rms, sample.stop);
    central.ray_share = std::min(1.0, paths.share);
    central.path_length = paths.share > 0 ? paths.length / paths.share : central.sphere_radius;
  } else {
    // lines are isotropic, so the share that crosses a sphere is known
    const double ratio = std::min(1.0, central.sphere_radius / sample.problem.enclosing().radius);
    central.ray_share = ratio * ratio;
  }
  return central;
}

Finding find_far_samples(const EffectSample& sample) {
  const Spread spread = spread_of(sample.problem);
  return {.value = spread.ratio, .apply = [&sample, spread](Workload& workload) {
            const FarDiscs found = discs_beyond(spread, sample.problem, sample.stop);
            if (found.far > 0) workload.central = samples_near(found, sample);
          }};
}

double far_samples_of_numbers(const Workload&) { return 1; }

}  // namespace

constinit const Effect far_samples{.name = "far samples",
                                   .evidence = "side of the samples' box, over that of the central 90 %",
                                   .threshold = {Threshold::Side::above, far_ratio, 0},
                                   .find = find_far_samples,
                                   .of_numbers = far_samples_of_numbers};

}  // namespace detp::sim
