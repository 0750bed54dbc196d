#pragma once

#include <span>
#include <vector>

#include "detp/model/rank/choose.hpp"

/// Selects those of our techniques that are worth running on a workload, and their parameters.
namespace detp::validate {

struct Contenders {
  std::vector<Candidate> candidates;  ///< shortest predicted time first; empty if none fits in memory
  double hits = 0;                    ///< expected number of hits, by the closed forms
};

/// The exact techniques, or only the exact techniques in `named` if it is not empty. Each has the parameters with the
/// shortest predicted time. Techniques without a closed form come last, with default parameters. Leaves out candidates
/// whose predicted time exceeds `hopeless` times that of the first.
[[nodiscard]] Contenders contenders(const Workload& workload, std::span<const Technique> named, double hopeless);

}  // namespace detp::validate
