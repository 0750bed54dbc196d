#pragma once

#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"

/// Candidates that are worth trying besides the predicted ones.
namespace detp::validate {

/// The exact techniques, with default parameters, that are not among these.
[[nodiscard]] std::vector<Candidate> techniques_left_out(const std::vector<Candidate>& candidates);

/// Candidates of the same technique with each parameter changed by the step of its record, within its range. A choice is
/// changed only if the technique has no other parameter.
[[nodiscard]] std::vector<Candidate> neighbours(const Candidate& candidate);

}  // namespace detp::validate
