#pragma once

#include <span>
#include <vector>

#include "detp/model/rank/choose.hpp"

/// Selects the techniques of ours that are worth running on a workload, and their parameters.
namespace detp::validate {

struct Contenders {
  std::vector<Candidate> candidates;  ///< fastest prediction first; empty if none fits in memory
  double hits = 0;                    ///< expected number, by the closed forms
};

/// The exact techniques, or those of them that `named` lists, each with the parameters that the closed forms find best.
/// Techniques without a closed form come last, with their defaults. Leaves out candidates predicted to take more than
/// `hopeless` times as long as the first.
[[nodiscard]] Contenders contenders(const Workload& workload, std::span<const Technique> named, double hopeless);

}  // namespace detp::validate
