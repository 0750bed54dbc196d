#include "colour_scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "labels.hpp"

namespace detp::validate {
namespace {

using Three = std::array<double, 3>;

/// Linear red, green, blue of a colour of OKLab in polar coordinates.
Three linear_rgb(double lightness, double chroma, double hue) {
  const double a = chroma * std::cos(hue);
  const double b = chroma * std::sin(hue);
  const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
  const double m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
  const double s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

bool is_shown(const Three& rgb) {
  return std::ranges::all_of(rgb, [](double part) { return part >= 0 && part <= 1; });
}

std::uint8_t in_srgb(double linear) {
  const double part = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(part, 0.0, 1.0)));
}

/// A curve through the colours: lightness and hue change evenly, chroma is what a screen can show, at most `full_chroma`.
struct Curve {
  static constexpr double full_chroma = 0.15;
  double lightness;
  double chroma;
  double hue;

  explicit Curve(double at) : lightness(0.2 + 0.76 * at), chroma(full_chroma), hue(5.3 - 3.4 * at) {
    if (is_shown(linear_rgb(lightness, chroma, hue))) return;
    double none = 0;  // of grey, which is shown
    while (chroma - none > 1e-6) {
      const double middle = 0.5 * (none + chroma);
      (is_shown(linear_rgb(lightness, middle, hue)) ? none : chroma) = middle;
    }
    chroma = none;
  }
  [[nodiscard]] Three lab() const { return {lightness, chroma * std::cos(hue), chroma * std::sin(hue)}; }
};

constexpr std::size_t steps = 1024;

/// Lengths of the curve up to each step, over the whole.
std::array<double, steps + 1> lengths_of_curve() {
  std::array<double, steps + 1> lengths{};
  Three before = Curve(0).lab();
  for (std::size_t i = 1; i <= steps; ++i) {
    const Three own = Curve(static_cast<double>(i) / steps).lab();
    lengths[i] = lengths[i - 1] + std::hypot(own[0] - before[0], own[1] - before[1], own[2] - before[2]);
    before = own;
  }
  for (double& length : lengths) length /= lengths.back();
  return lengths;
}

double at_share(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(std::lround(share * static_cast<double>(sorted.size() - 1)))];
}

}  // namespace

Colour scale_colour(double share) {
  static const std::array<Colour, 512> colours = [] {
    const auto lengths = lengths_of_curve();
    std::array<Colour, 512> all{};
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double length = static_cast<double>(i) / static_cast<double>(all.size() - 1);
      const auto place = std::ranges::lower_bound(lengths, length) - lengths.begin();
      const Curve at(static_cast<double>(place) / steps);
      const Three rgb = linear_rgb(at.lightness, at.chroma, at.hue);
      all[i] = {in_srgb(rgb[0]), in_srgb(rgb[1]), in_srgb(rgb[2])};
    }
    return all;
  }();
  return colours[static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(colours.size() - 1) + 0.5)];
}

double ColourScale::share(double number) const {
  if (!logarithmic) return std::clamp((number - low) / (high - low), 0.0, 1.0);
  return number > low ? std::clamp(std::log(number / low) / std::log(high / low), 0.0, 1.0) : 0.0;
}

std::vector<double> ColourScale::ticks(int most) const {
  return logarithmic ? ticks_between(std::log10(low), std::log10(high), true, most)
                     : ticks_between(low, high, false, most);
}

ColourScale scale_of(std::span<const double> numbers, Scaling scaling) {
  std::vector<double> sorted;
  for (const double number : numbers)
    if (number > 0 && std::isfinite(number)) sorted.push_back(number);
  if (sorted.empty()) return {};
  std::ranges::sort(sorted);
  ColourScale scale{.largest = sorted.back()};
  const double nearly_all = at_share(sorted, 0.995);
  scale.high = sorted.back() > 1.2 * nearly_all ? nearly_all : sorted.back();
  scale.logarithmic =
      scaling == Scaling::logarithmic || (scaling == Scaling::automatic && scale.high > 12 * at_share(sorted, 0.5));
  if (scale.logarithmic) scale.low = std::min(std::max(at_share(sorted, 0.01), scale.high * 1e-4), scale.high * 0.5);
  return scale;
}

}  // namespace detp::validate
