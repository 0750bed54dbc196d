#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "detp/validate/base/fields.hpp"
#include "technique_map.hpp"

/// What text, tables and picture say of a map: its fields, its words, and where prediction and measurement agree.
namespace detp::validate {

struct Agreement {
  std::size_t cells = 0;                ///< measured
  std::size_t agree = 0;                ///< with the same technique
  std::vector<PlacedCell> disagreeing;  ///< largest loss first
  double mean_slowdown = 1;             ///< geometric mean of 1 + slower over all measured cells
  double worst_slowdown = 1;

  /// agree / cells; requires cells > 0.
  [[nodiscard]] double share() const { return static_cast<double>(agree) / static_cast<double>(cells); }
  [[nodiscard]] std::size_t within_noise() const;  ///< of those that disagree
};

/// Of the measured cells. It refers to the map's rows.
[[nodiscard]] Agreement agreement_of(const TechniqueMap& map);

/// Of the whole map: its JSON.
[[nodiscard]] const Fields<TechniqueMap>& map_fields();

/// Of a cell: `cells` in JSON, and the rows of the table.
[[nodiscard]] const Fields<PlacedCell>& map_cell_fields();

/// What the fields of the map and of its cells mean.
[[nodiscard]] std::vector<FieldText> describe_map();

/// "4 %", or the length "0.02".
[[nodiscard]] std::string radius_label(const Length& radius);

/// "@tree: 85967 discs of dimension D = 2.13, photon paths". Requires at least one row.
[[nodiscard]] std::string describe(const TechniqueMap& map);

/// The edges of cells around ascending values > 0 on a logarithmic axis: the geometric means of neighbours. The first
/// and the last cell are symmetric. A single cell reaches from value/√10 to value·√10. One edge more than values.
[[nodiscard]] std::vector<double> cell_edges(const std::vector<double>& values);

/// The map as SVG: panels with the predicted technique, the measured technique (if a cell was measured) and that of the
/// paper's rule, over logarithmic axes. Each cell has its technique's colour and code, and the time of its fastest candidate;
/// lines separate the regions. A filled corner marks cells where another technique than the predicted one was faster,
/// an open corner where the difference is within noise. The same map gives the same bytes on the same machine.
///
/// `machine`: the CPU; `program`: "detp 0.1.0". The text width in the picture is estimated, as the font is the viewer's. Throws
/// std::invalid_argument for a map without rows.
[[nodiscard]] std::string map_svg(const TechniqueMap& map, const std::string& machine, const std::string& program);

}  // namespace detp::validate
