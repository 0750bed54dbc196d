#pragma once

#include <algorithm>

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::model {

/// Mean square distance of the samples from the centre of their box, length²:
///
///     (a² + b² + c²)/12 in its volume (D = 3),  5 (a² + b² + c²)/36 on its faces (D = 2)
///
///   where  a, b, c   sides of the box, length
///
/// Source     our derivation; on the faces exact for a cube, because all three pairs of faces have the same weight.
///            Interpolated for D between 2 and 3.
/// Throws     nothing; the caller checks the workload.
[[nodiscard]] inline double mean_square_distance(const Valid<Workload>& workload) {
  double squares = 0;
  for (const double side : workload.box) squares += side * side;
  const double volume = std::clamp(workload.dimension - 2, 0.0, 1.0);
  return squares * (volume / 12 + (1 - volume) * 5 / 36);
}

}  // namespace detp::model
