#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "claim.hpp"
#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/open/uniform_discs.hpp"

namespace detp::validate {

/// Number of independent batches from which every standard error is computed: enough for Student's t to be close to the
/// normal distribution.
inline constexpr int batch_count = 32;

/// The seed for one use of random numbers: `part` numbers the uses in the claims, `batch` the batches or sets (-1 for
/// data that all batches share). Neighbouring seeds of the user give seeds that are far apart.
[[nodiscard]] inline std::uint64_t batch_seed(const Experiment& experiment, int part, int batch) {
  return experiment.seed * 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(part) * 1000003ULL +
         static_cast<std::uint64_t>(batch);
}

/// Lines per batch, for claims whose predictions do not depend on the number of rays: `most` if the workload has a
/// million rays or more, else proportionally fewer (at least 100), so that small workloads finish soon.
[[nodiscard]] inline std::size_t lines_per_batch(const Experiment& experiment, std::size_t most) {
  const double share = std::min(1.0, experiment.workload.rays / 1e6);
  return std::max<std::size_t>(100, static_cast<std::size_t>(share * static_cast<double>(most)));
}

/// Returns the vector of one(b) for all batches b, computed in parallel. The result does not depend on the order of
/// execution. Throws sim::Stopped if a stop was requested.
template <class One>
auto for_each_batch(const Experiment& experiment, const One& one) {
  std::vector<decltype(one(0))> results(batch_count);
  sim::parallel_for(0, batch_count, [&](int batch) {
    sim::StopCheck(experiment.stop, "counting").now();
    results[static_cast<std::size_t>(batch)] = one(batch);
  });
  return results;
}

/// What each batch found: a number for each quantity.
using BatchNumbers = std::vector<std::vector<double>>;

/// Mean of a quantity over the batches, less that of another if there is one.
[[nodiscard]] inline Estimate mean_of(const BatchNumbers& batches, std::size_t quantity,
                                      std::optional<std::size_t> less = {}) {
  std::vector<double> values;
  for (const auto& batch : batches) values.push_back(batch[quantity] - (less ? batch[*less] : 0));
  return batch_means(values);
}

/// Geometric mean of a quantity whose logarithms the batches have; of its ratio to another if there is one. The standard error is that of the
/// mean logarithm, multiplied by the mean.
[[nodiscard]] inline Estimate geometric_mean_of(const BatchNumbers& logarithms, std::size_t quantity,
                                                std::optional<std::size_t> over = {}) {
  const Estimate log = mean_of(logarithms, quantity, over);
  return {std::exp(log.mean), std::exp(log.mean) * log.standard_error};
}

/// What all findings of an experiment have.
struct CommonFacts {
  std::string_view technique = {};  ///< empty: as the findings say
  double tolerance = 0;
  std::size_t lines = 0;  ///< of each batch
  const sim::Stopwatch& clock;
};

[[nodiscard]] inline std::vector<Finding> completed(std::vector<Finding> findings, const CommonFacts& facts) {
  for (Finding& finding : findings) {
    if (!facts.technique.empty()) finding.technique = facts.technique;
    finding.batches = batch_count;
    finding.tolerance = facts.tolerance;
    finding.lines = facts.lines * batch_count;
    finding.seconds = facts.clock.seconds();
  }
  return findings;
}

/// Lines of a batch that are the workload's, divided among the batches.
[[nodiscard]] inline std::size_t share_of_rays(const Experiment& experiment) {
  return std::max<std::size_t>(100, static_cast<std::size_t>(experiment.workload.rays) / batch_count);
}

/// The scene's discs, or without a scene, set number `set` of uniform discs with the properties of the workload.
[[nodiscard]] inline std::vector<sim::Disc> sample_discs(const Experiment& experiment, int set) {
  if (!experiment.discs.empty()) return experiment.discs;
  const Workload& workload = experiment.workload;
  return sim::uniform_discs(workload.dimension < 2.5 ? sim::Body::cube_faces : sim::Body::cube, scene_side(workload),
                            static_cast<std::size_t>(workload.samples), workload.disc_radius,
                            batch_seed(experiment, 10, set), experiment.stop);
}

/// The bias of discs in smooth light (c₄ of model/accuracy/scene_error.hpp): parallel light whose Laplacian is the same everywhere,
/// so that no higher term adds to the bias. Throws sim::Stopped.
[[nodiscard]] Finding smooth_bias_finding(const Experiment& experiment);

}  // namespace detp::validate
