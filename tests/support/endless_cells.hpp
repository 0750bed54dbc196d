#pragma once

#include <numbers>

#include "detp/model/disc_index/index_overlap.hpp"

/// Mean number of cells that a uniformly placed isotropic disc overlaps in an endless grid of cubic cells: the limit
/// for an index with many small cells. x = d/a; index_overlap.hpp introduces d, a and h_i.
namespace detp::support {

/// Cells that the disc overlaps: 1 + (3π/2) x + (3π/2) x². Each plane of the grid that crosses the disc adds a cell,
/// and so does each line of the grid that pierces the disc. Planes of one axis: 2 E[h]/a = (π/2) x. Lines along one
/// axis: the disc's projection along the axis has the area π d² E|n| = (π/2) d², so (π/2) x².
inline double overlapped_cells(double x) { return 1 + 1.5 * std::numbers::pi * x * (1 + x); }

/// Cells that the disc's bounding box overlaps: E ∏ (1 + 2h_i/a), because the box's place along each axis is uniform.
inline double boxed_cells(double x) {
  using namespace model;
  return 1 + x * (1.5 * std::numbers::pi + x * (12 * mean_reach_product_2 + 8 * mean_reach_product_3 * x));
}

}  // namespace detp::support
