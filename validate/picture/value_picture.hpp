#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "colour_scale.hpp"

/// Pictures of numbers seen on surfaces, with bars that say which colour is which number.
namespace detp::validate {

inline constexpr double no_surface = -std::numeric_limits<double>::infinity();  ///< background
inline constexpr double not_known = std::numeric_limits<double>::quiet_NaN();   ///< a surface without a number: grey

/// A picture of width × height pixels, each of fineness × fineness cells.
struct ValuePanel {
  static constexpr int fineness = 2;
  std::string title;
  int width = 0;
  int height = 0;
  std::vector<double> cells;   ///< by rows from the top left: a number ≥ 0, no_surface or not_known
  std::vector<char> outlines;  ///< of the cells: 1 is an edge of a surface
  ColourScale scale = {};
};

/// Panels side by side in rows, all of the same size.
using PanelRows = std::vector<std::vector<ValuePanel>>;

/// Throws std::invalid_argument if there are no panels, or of different sizes.
[[nodiscard]] std::string picture_png(const PanelRows& rows);
/// The same; bars and texts are vectors. `description` is for those who do not see it.
[[nodiscard]] std::string picture_svg(const PanelRows& rows, const std::string& description);

}  // namespace detp::validate
