#pragma once

#include <string>
#include <string_view>

#include "detp/model/vocabulary/technique.hpp"

/// How a map shows a technique: a code of letters and a colour.
namespace detp::validate {

/// The initials of a name of several words ("bt" for box-tree), the first two letters of a name of one word.
[[nodiscard]] std::string code_of(Technique technique);

/// "#332288". Exact techniques have different colours, as long as there are at most ten: nine of the scheme "muted" by
/// Paul Tol (2021), which people with any colour vision can tell apart, and grey.
[[nodiscard]] std::string_view colour_of(Technique technique);

/// "#ffffff" or "#000000": which of them has more contrast (WCAG 2) to the technique's colour.
[[nodiscard]] std::string_view text_colour_on(Technique technique);

}  // namespace detp::validate
