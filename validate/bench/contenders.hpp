#pragma once

#include <span>
#include <vector>

#include "detp/model/rank/choose.hpp"

/// Which of our techniques are worth running on a workload, and with which parameters.
namespace detp::validate {

struct Contenders {
  std::vector<Candidate> candidates;  ///< the one expected to be the fastest first; empty if none fits the memory
  double hits = 0;                    ///< expected, by the closed forms
};

/// The exact techniques, or those of them that are named, each with the parameters that the closed forms find best;
/// those that have no closed form with their defaults, last. Left out is what is predicted to be slower than `hopeless`
/// times the first.
[[nodiscard]] Contenders contenders(const Workload& workload, std::span<const Technique> named, double hopeless);

}  // namespace detp::validate
