#include "words.hpp"

#include <fmt/format.h>

#include <cmath>

namespace detp::cli {

std::string number_of_times(double ratio) {
  return ratio >= 1000 && ratio < 1e6 ? fmt::format("{:.0f} times", ratio) : fmt::format("{:.3g} times", ratio);
}

std::string as_long(double ratio, const std::string& other) {
  constexpr double least_percent = 0.005;  // smaller differences are not worth naming
  const std::string than = other.empty() ? "" : " than " + other;
  const std::string as = other.empty() ? "" : " as " + other;
  if (ratio >= 1.995) return number_of_times(ratio) + " as long" + as;
  if (ratio >= 1 + least_percent) return fmt::format("{:.0f} % longer{}", 100 * (ratio - 1), than);
  return ratio > 1 - least_percent ? "as long" + as : fmt::format("{:.0f} % less time{}", 100 * (1 - ratio), than);
}

std::string how_far_off(double ratio, const std::string& high, const std::string& low) {
  if (std::abs(ratio - 1) < 0.01) return "right within 1 %";
  if (ratio >= 1.995) return number_of_times(ratio) + " " + high;
  if (ratio > 1) return fmt::format("{:.0f} % {}", 100 * (ratio - 1), high);
  return ratio > 0.5 ? fmt::format("{:.0f} % {}", 100 * (1 - ratio), low)
         : ratio > 0 ? number_of_times(1 / ratio) + " " + low
                     : "0";
}

}  // namespace detp::cli
