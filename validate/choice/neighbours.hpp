#pragma once

#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"

/// Candidates that are worth trying besides the predicted ones.
namespace detp::validate {

/// The exact techniques, with default parameters, that are not among these.
[[nodiscard]] std::vector<Candidate> techniques_left_out(const std::vector<Candidate>& candidates);

/// Candidates of the same technique with each parameter changed by one step, within its range: one level of depth or
/// one sphere more or less; Q 15 % larger or smaller; twice or half the fan-out; leaves four times as large or small;
/// other numbers by a factor of 1.4. A choice is changed only if the technique has no other parameter.
[[nodiscard]] std::vector<Candidate> neighbours(const Candidate& candidate);

}  // namespace detp::validate
