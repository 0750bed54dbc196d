#pragma once

#include <string>

/// Short texts of numbers, for pictures.
namespace detp::validate {

/// 100 000 as "1e5", 12 345 as "1.23e4", 50 as "50".
[[nodiscard]] std::string rays_label(double rays);

/// With two significant digits and a unit: "0.84 ms", "1.2 s".
[[nodiscard]] std::string seconds_label(double seconds);

/// "12 %", "0.034 %".
[[nodiscard]] std::string percent_label(double share);

/// With three significant digits.
[[nodiscard]] std::string number_label(double number);

}  // namespace detp::validate
