#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "claim.hpp"
#include "detp/sim/base/stop_check.hpp"

namespace detp::validate {

/// Number of independent batches behind every standard error: enough for Student's t to be close to the normal
/// distribution.
inline constexpr int batch_count = 32;

/// A seed for part `part` of batch `batch`. It is far from those of the user's neighbouring seeds.
[[nodiscard]] inline std::uint64_t batch_seed(const Experiment& experiment, int part, int batch) {
  return experiment.seed * 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(part) * 1000003ULL +
         static_cast<std::uint64_t>(batch);
}

/// Lines per batch, for claims that do not depend on the number of rays: `most` for a million rays or more,
/// proportionally fewer for fewer rays, so that small workloads finish soon.
[[nodiscard]] inline std::size_t lines_per_batch(const Experiment& experiment, std::size_t most) {
  const double share = std::min(1.0, experiment.workload.rays / 1e6);
  return std::max<std::size_t>(100, static_cast<std::size_t>(share * static_cast<double>(most)));
}

/// result[b] = one(b) for all batches, in parallel. Each batch writes its own element, so the result does not depend on
/// the order of execution. Throws sim::Stopped if a stop was requested.
template <class One>
auto for_each_batch(const Experiment& experiment, const One& one) {
  std::vector<decltype(one(0))> results(batch_count);
  tbb::parallel_for(0, batch_count, [&](int batch) {
    sim::StopCheck(experiment.stop, "counting").now();
    results[static_cast<std::size_t>(batch)] = one(batch);
  });
  return results;
}

}  // namespace detp::validate
