#pragma once

#include <vector>

#include "detp/model/vocabulary.hpp"

/// Candidates that are worth a try beside the predicted ones.
namespace detp::validate {

/// The exact techniques, with default parameters, that are not among these.
[[nodiscard]] std::vector<Candidate> techniques_left_out(const std::vector<Candidate>& candidates);

/// The same technique with parameters a step away, all within their ranges: one level of depth; 0.7 and 1.4 times the
/// cells; other Q and one sphere more or less; trees of boxes with 4 and 8 children, leaves of 8, 16, 64; the other
/// quality of a bvh; leaves of a BSP tree four times as large or small.
[[nodiscard]] std::vector<Candidate> neighbours(const Candidate& candidate);

}  // namespace detp::validate
