#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::sim {

/// The extent that samples of this box and dimension fill, if they lie on surfaces with the area; computed from the box
/// if the area is 0. Computed from the samples' own box, because samples need not fill the scene's box.
[[nodiscard]] double extent_on_surfaces(Workload samples, double area);

}  // namespace detp::sim
