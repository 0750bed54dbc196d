#pragma once

#include <optional>
#include <string>
#include <vector>

#include "detp/model/vocabulary/technique.hpp"

/// A table of techniques as a picture in a page: a colour and a code for each cell.
namespace detp::validate {

/// What a cell of a table of techniques shows.
struct ZoneCell {
  Technique technique;
  std::string value;    ///< in words
  std::string seconds;  ///< second line; may be empty
  bool framed = false;
};

/// Cells of techniques: rows from above, columns from the left.
struct ZoneChart {
  std::string description;
  std::string x_title;
  std::string y_title;
  std::vector<std::string> columns;
  std::vector<std::string> rows;
  std::vector<std::vector<std::optional<ZoneCell>>> cells;
};

/// The same size of text as chart_svg, with a legend of the techniques. Throws std::invalid_argument for a chart without cells.
[[nodiscard]] std::string zone_svg(const ZoneChart& chart);

}  // namespace detp::validate
