#pragma once

#include <vector>

#include "batches.hpp"
#include "detp/sim/open/uniform_discs.hpp"

namespace detp::validate {

/// The scene's discs, or without a scene, set number `set` of uniform discs with the properties of the workload.
[[nodiscard]] inline std::vector<sim::Disc> sample_discs(const Experiment& experiment, int set) {
  if (!experiment.discs.empty()) return experiment.discs;
  const Workload& workload = experiment.workload;
  return sim::uniform_discs(workload.dimension < 2.5 ? sim::Body::cube_faces : sim::Body::cube, scene_side(workload),
                            static_cast<std::size_t>(workload.samples), workload.disc_radius,
                            batch_seed(experiment, 10, set), experiment.stop);
}

}  // namespace detp::validate
