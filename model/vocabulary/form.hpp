#pragma once

#include "parameter.hpp"

namespace detp {

/// The version of a formula.
enum class Form {
  published,  ///< as the paper printed it
  corrected   ///< as corrected by derivation and simulation
};
template <>
inline constexpr std::array<std::string_view, 2> choice_names<Form>{"published", "corrected"};

/// What a choice is based on.
enum class Rigor {
  estimate,    ///< closed forms alone
  structural,  ///< rays of the same kind, but not those of the run, through parts of the index
  pilot,       ///< some of the rays, through parts of the index
  measure      ///< runs of the candidates
};
template <>
inline constexpr std::array<std::string_view, 4> choice_names<Rigor>{"estimate", "structural", "pilot", "measure"};

}  // namespace detp
