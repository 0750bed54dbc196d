#pragma once

#include <string>

#include "detp/validate/base/json.hpp"

/// Words: for a shell, and for ratios.
namespace detp::cli {

using validate::shell_word;

/// How much longer something takes, by its time over that of another: "30 % longer", "2.4 times as long", "as long". With the name
/// of the other: "30 % longer than grid".
[[nodiscard]] std::string as_long(double ratio, const std::string& other = "");

/// "2.4 times", "1110 times", "1.2e+06 times".
[[nodiscard]] std::string number_of_times(double ratio);

/// How far a prediction is off, by predicted over true value: "12 % too high", "2.4 times too low", "right within 1 %".
/// `high` and `low` are the adjectives.
[[nodiscard]] std::string how_far_off(double ratio, const std::string& high = "too high",
                                      const std::string& low = "too low");

}  // namespace detp::cli
