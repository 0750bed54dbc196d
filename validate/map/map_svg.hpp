#pragma once

#include <string>

#include "technique_map.hpp"

/// Draws a map.
namespace detp::validate {

/// What the picture says beside the map itself.
struct MapCaption {
  std::string machine;  ///< the CPU
  std::string program;  ///< "detp 0.1.0"
  std::string costs;    ///< where the unit costs come from
};

/// The map as SVG: panels with the predicted technique, the measured technique (if a cell was measured) and that of the
/// paper's rule, over logarithmic axes. Each cell has its technique's colour and code, and the time of its fastest candidate;
/// lines separate the regions. A filled corner marks cells where another technique than the predicted one was faster,
/// an open corner where the difference is within noise. The same map and caption give the same bytes.
///
/// The text width in the picture is estimated, as the font is the viewer's. Throws std::invalid_argument for a map
/// without rows.
[[nodiscard]] std::string map_svg(const TechniqueMap& map, const MapCaption& caption);

}  // namespace detp::validate
