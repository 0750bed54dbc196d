#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"

/// Simple rules that need no cost model, with which the choices are compared.
namespace detp::validate {

struct Baseline {
  std::string_view name;  ///< in results: "best_constant"
  std::string_view text;  ///< "best constant"
  bool by_workload;       ///< the candidates differ from workload to workload
  /// The candidates of the rule on a workload, of which one counts: the one with the smallest geometric mean of its
  /// regrets on the fitted workloads. Always the same number.
  std::vector<Candidate> (*candidates)(const Workload&);
};

/// best constant        box trees with a fan-out of 4, 8 or 16 and leaves of 16 or 64
/// usual shape          box tree with the shape of usual_shape()
/// paper's rule         model::paper_rule
/// always Embree        bvh with quality low or medium
/// always brute force   brute-force
[[nodiscard]] const std::array<Baseline, 5>& baselines();

}  // namespace detp::validate
