#include "labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace detp::validate {
namespace {

constexpr std::array<std::string_view, 10> colours{"#bbbbbb", "#332288", "#88ccee", "#44aa99", "#ddcc77",
                                                   "#117733", "#cc6677", "#999933", "#882255", "#aa4499"};

/// Relative luminance (WCAG 2) of "#rrggbb".
double luminance(std::string_view colour) {
  constexpr std::array weights{0.2126, 0.7152, 0.0722};
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    int value = 0;
    std::from_chars(colour.data() + 1 + 2 * i, colour.data() + 3 + 2 * i, value, 16);
    const double share = value / 255.0;
    sum += weights[i] * (share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4));
  }
  return sum;
}

/// Steps of 1, 2 or 5 times a power of ten that divide the range into at most `most` parts.
double step_of(double range, int most) {
  const double power = std::pow(10.0, std::floor(std::log10(range / most)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (range / (factor * power) <= most) return factor * power;
  return 10 * power;
}

}  // namespace

std::vector<double> ticks_between(double low, double high, bool logarithmic, int most) {
  std::vector<double> found;
  if (!logarithmic || high - low < 1) {  // less than a decade has too few powers of ten
    const double from = logarithmic ? std::pow(10.0, low) : low;
    const double to = logarithmic ? std::pow(10.0, high) : high;
    const double step = step_of(to - from, logarithmic ? std::max(1, most / 2) : most);
    for (double i = std::ceil(from / step); i * step <= to; ++i) found.push_back(i * step);
    return found;
  }
  for (const std::vector<double>& digits : {std::vector<double>{1, 2, 5}, {1, 3}, {1}}) {
    found.clear();
    for (double power = std::floor(low); power <= high; ++power)
      for (const double digit : digits) {
        const double at = power + std::log10(digit);
        if (at >= low && at <= high) found.push_back(digit * std::pow(10.0, power));
      }
    if (static_cast<int>(found.size()) <= most) return found;
  }
  const auto decades = static_cast<int>(found.size());
  const int every = (decades + most - 1) / most;
  std::vector<double> some;
  for (int i = 0; i < decades; i += every) some.push_back(found[static_cast<std::size_t>(i)]);
  return some;
}

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

std::string code_of(Technique technique) {
  const std::string_view full = name(technique);
  std::string code(1, full[0]);
  for (std::size_t i = 1; i + 1 < full.size(); ++i)
    if (full[i] == '-') code += full[i + 1];
  if (code.size() == 1) code += full[1];
  return code;
}

std::string_view colour_of(Technique technique) {
  const auto place = std::ranges::find(exact_techniques, technique) - exact_techniques.begin();
  return colours[static_cast<std::size_t>(place) % colours.size()];
}

std::string_view text_colour_on(Technique technique) {
  const double background = luminance(colour_of(technique)) + 0.05;
  return 1.05 / background > background / 0.05 ? "#ffffff" : "#000000";
}

}  // namespace detp::validate
