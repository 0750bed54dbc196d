#pragma once

#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"

/// Candidates to try in addition to the ranked ones.
namespace detp::validate {

/// The exact techniques that none of these candidates uses, with default parameters.
[[nodiscard]] std::vector<Candidate> techniques_left_out(const std::vector<Candidate>& candidates);

/// Candidates of the same technique that differ in one parameter. Numbers are changed one step up and one step down
/// (Parameter::step), within their range. A parameter with named choices is changed only if the technique has no other
/// parameter.
[[nodiscard]] std::vector<Candidate> neighbours(const Candidate& candidate);

}  // namespace detp::validate
