#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "detp/model/vocabulary/technique.hpp"

/// How pictures show numbers and techniques: short texts of numbers; a code of letters and a colour of a technique.
namespace detp::validate {

/// Round numbers of an axis from low to high, at most `most`. Ends of a logarithmic axis are logarithms to base 10; its ticks are not.
[[nodiscard]] std::vector<double> ticks_between(double low, double high, bool logarithmic, int most);

/// 100 000 as "1e5", 12 345 as "1.23e4", 50 as "50".
[[nodiscard]] std::string rays_label(double rays);

/// With two significant digits and a unit: "0.84 ms", "1.2 s".
[[nodiscard]] std::string seconds_label(double seconds);

/// "12 %", "0.034 %".
[[nodiscard]] std::string percent_label(double share);

/// With three significant digits.
[[nodiscard]] std::string number_label(double number);

/// The initials of a name of several words ("bt" for box-tree), the first two letters of a name of one word.
[[nodiscard]] std::string code_of(Technique technique);

/// "#332288". Exact techniques have different colours, as long as there are at most ten: nine of the scheme "muted" by
/// Paul Tol (2021), which people with any colour vision can tell apart, and grey.
[[nodiscard]] std::string_view colour_of(Technique technique);

/// "#ffffff" or "#000000": which of them has more contrast (WCAG 2) to the technique's colour.
[[nodiscard]] std::string_view text_colour_on(Technique technique);

}  // namespace detp::validate
