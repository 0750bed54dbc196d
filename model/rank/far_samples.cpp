#include "far_samples.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "detp/model/lines/line_measure.hpp"

namespace detp::model {

Workload central_workload(const Workload& workload) {
  assert(workload.central);
  const CentralSamples& central = *workload.central;
  Workload part = workload;
  part.central.reset();
  part.nodes.clear();
  part.ray_density = 1;
  part.hit_ratio = 1;
  part.rays = std::max(1.0, std::round(workload.rays * central.ray_share));
  part.samples = central.samples;
  part.sphere_radius = central.sphere_radius;
  part.box = central.box;
  part.dimension = central.dimension;
  part.sample_extent = central.sample_extent;
  part.path_length = central.path_length;
  return part;
}

Workload far_workload(const Workload& workload, double parts) {
  assert(workload.central);
  Workload part = workload;
  part.central.reset();
  part.nodes.clear();
  part.ray_density = 1;
  part.hit_ratio = 1;
  part.samples = workload.samples - workload.central->samples + parts;
  part.dimension = 3;
  part.sample_extent = 0;
  return part;
}

Counts<double> with_far_samples(const Workload& workload, const Counts<double>& central, const Counts<double>& far) {
  Counts<double> counts = central;
  counts += far;
  counts.hits = workload.path_length > 0 ? central.hits : expected_hits(workload);  // segments hardly hit far discs
  for (const auto term : {&Counts<double>::references, &Counts<double>::placements, &Counts<double>::sorted})
    counts.*term = std::min(counts.*term, workload.samples);
  return counts;
}

}  // namespace detp::model
