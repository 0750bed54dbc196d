#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bitmap.hpp"

/// Colours of numbers.
namespace detp::validate {

/// The colour at a share 0 … 1 of the scale, from dark violet to light yellow. Equal steps look equally large: they are as far apart in
/// OKLab (B. Ottosson, "A perceptual color space for image processing", 2020), and lighter all the way.
[[nodiscard]] Colour scale_colour(double share);

enum class Scaling { automatic, linear, logarithmic };

inline constexpr std::array<std::pair<std::string_view, Scaling>, 3> named_scalings{
    {{"auto", Scaling::automatic}, {"linear", Scaling::linear}, {"log", Scaling::logarithmic}}};

/// Which numbers have the first and the last colour.
struct ColourScale {
  double low = 0;
  double high = 1;
  bool logarithmic = false;
  double largest = 1;  ///< of all numbers; from `high` on all look alike

  /// The place of a number on the scale, 0 … 1.
  [[nodiscard]] double share(double number) const;
  /// Where labels are, at most `most`, rising.
  [[nodiscard]] std::vector<double> ticks(int most) const;
};

/// The scale for these numbers, of which those > 0 and finite count. It ends below the largest half percent of them, if these are more than a fifth above. Linear scales begin at 0;
/// logarithmic ones where a hundredth of the numbers is below, at most four decades below the end. Automatic: logarithmic if the end is
/// more than 12 times the median. Without numbers 0 to 1.
[[nodiscard]] ColourScale scale_of(std::span<const double> numbers, Scaling scaling);

}  // namespace detp::validate
