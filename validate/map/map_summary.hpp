#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "technique_map.hpp"

/// What text and picture say of a map: its words and numbers, and where prediction and measurement of a cell agree.
namespace detp::validate {

/// How a measured cell compares with its prediction.
struct CellVerdict {
  bool agrees = false;        ///< the predicted technique was the fastest measured one
  double slower = 0;          ///< measured time of the predicted choice / shortest measured time, minus 1
  bool within_noise = false;  ///< the ranges of the two times, median ± half range, overlap
};

/// The verdict on a measured cell. Requires cell.analysis.
[[nodiscard]] CellVerdict verdict_of(const MapCell& cell);

struct Disagreement {
  const MapRow* row;    ///< of the map
  const MapCell* cell;  ///< of this row
  CellVerdict verdict;
};

struct Agreement {
  std::size_t cells = 0;                  ///< measured
  std::size_t agree = 0;                  ///< with the same technique
  std::vector<Disagreement> disagreeing;  ///< largest loss first
  double mean_slowdown = 1;               ///< geometric mean of 1 + slower over all measured cells
  double worst_slowdown = 1;

  /// agree / cells; requires cells > 0.
  [[nodiscard]] double share() const { return static_cast<double>(agree) / static_cast<double>(cells); }
  [[nodiscard]] std::size_t within_noise() const;  ///< of those that disagree
};

/// Of the measured cells. It refers to the map's rows.
[[nodiscard]] Agreement agreement_of(const TechniqueMap& map);

/// "4 %", or the length "0.02".
[[nodiscard]] std::string radius_label(const Length& radius);

/// "@tree: 85967 discs of dimension D = 2.13, photon paths". Requires at least one row.
[[nodiscard]] std::string describe(const TechniqueMap& map);

}  // namespace detp::validate
