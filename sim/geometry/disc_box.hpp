#pragma once

#include "geometry.hpp"

namespace detp::sim {

/// The smallest axis-aligned box around a disc, grown by `slack` on all sides.
[[nodiscard]] Box bounds(const Disc& disc, double slack);

/// Whether the disc overlaps the box grown by `slack` on all sides, or nearly does. If the slack exceeds the rounding
/// errors, no overlap with the box itself is missed.
///
/// The disc's plane cuts the grown box in a convex polygon. Returns true if the polygon's point nearest to the disc's
/// centre is within the radius plus the slack.
[[nodiscard]] bool overlaps(const Disc& disc, const Box& box, double slack);

}  // namespace detp::sim
