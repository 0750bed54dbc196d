#pragma once

#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"

/// Candidates that are worth a try beside the predicted ones.
namespace detp::validate {

/// The exact techniques, with default parameters, that are not among these.
[[nodiscard]] std::vector<Candidate> techniques_left_out(const std::vector<Candidate>& candidates);

/// The same technique with parameters a step away, all within their ranges: one level of depth or one sphere
/// more or less; Q 15 % larger or smaller; twice or half the fan-out; leaves four times as large or small; other
/// numbers 1.4 times; another choice where there is nothing else to change.
[[nodiscard]] std::vector<Candidate> neighbours(const Candidate& candidate);

}  // namespace detp::validate
