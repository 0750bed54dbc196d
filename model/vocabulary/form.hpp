#pragma once

#include "parameter.hpp"

/// Where a prediction comes from.
namespace detp {

/// Which version of a formula.
enum class Form {
  published,  ///< as the paper printed it
  corrected   ///< as derivation and simulation say it should be
};
template <>
inline constexpr std::array<std::string_view, 2> choice_names<Form>{"published", "corrected"};

/// What a choice rests on.
enum class Rigor {
  estimate,   ///< closed forms alone
  structural  ///< the structures that the techniques build of the discs
};
template <>
inline constexpr std::array<std::string_view, 2> choice_names<Rigor>{"estimate", "structural"};

}  // namespace detp
