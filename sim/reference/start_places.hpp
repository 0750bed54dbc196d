#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "detp/sim/photons/ray_caster.hpp"

namespace detp::sim {

/// Where a backward path starts, in the caster's own coordinates.
struct StartPlace {
  glm::dvec3 point{0.0};
  std::optional<std::uint32_t> triangle = {};  ///< on which it lies; none: in space
};

/// The places that stand for a sample: one on each triangle within `reach` (in the caster's own units) whose plane is about that of the
/// sample. A sample at a vertex lies on the border of surfaces, and one from a file beside them by a rounding error: a path from there
/// would pass through a surface, or begin behind it. So the places are inside of the triangles, by a thousandth of their size. Without
/// such a triangle: the sample itself.
[[nodiscard]] std::vector<StartPlace> start_places(const RayCaster& caster, const Sample& sample, double reach);

}  // namespace detp::sim
