#include "number_labels.hpp"

#include <fmt/format.h>

namespace detp::validate {

std::string rays_label(double rays) {
  if (rays < 100) return fmt::format("{:g}", rays);
  const std::string digits = fmt::format("{:.2e}", rays);  // "1.20e+04"
  std::string mantissa = digits.substr(0, 4);
  mantissa.erase(mantissa.find_last_not_of('0') + 1);
  if (mantissa.back() == '.') mantissa.pop_back();
  return fmt::format("{}e{}", mantissa, std::stoi(digits.substr(5)));
}

std::string seconds_label(double seconds) {
  const bool short_time = seconds < 0.9995;
  const double shown = short_time ? 1e3 * seconds : seconds;
  const char* const unit = short_time ? "ms" : "s";
  return shown < 99.5 ? fmt::format("{:.2g} {}", shown, unit) : fmt::format("{:.0f} {}", shown, unit);
}

std::string percent_label(double share) {
  const double percent = 100 * share;
  return percent < 99.5 ? fmt::format("{:.2g} %", percent) : fmt::format("{:.0f} %", percent);
}

std::string number_label(double number) { return fmt::format("{:.3g}", number); }

}  // namespace detp::validate
