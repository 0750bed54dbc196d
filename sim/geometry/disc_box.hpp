#pragma once

#include "geometry.hpp"

namespace detp::sim {

/// The smallest axis-aligned box around a disc, grown by `slack` on all sides.
[[nodiscard]] Box bounds(const Disc& disc, double slack);

/// Whether the disc comes within the box grown by `slack` on all sides. Exact but for rounding, which the slack must
/// exceed: it never misses an overlap of the box itself.
///
/// The disc's plane cuts the box in a convex polygon; they overlap if its nearest point to the centre is within the
/// radius.
[[nodiscard]] bool overlaps(const Disc& disc, const Box& box, double slack);

}  // namespace detp::sim
