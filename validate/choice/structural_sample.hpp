#pragma once

#include <cstddef>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/geometry/geometry.hpp"

namespace detp::validate {

/// `count` rays such as the workload describes, for a pilot:
///
///     lines      uniform isotropic lines through the sphere
///     segments   pieces of such lines: of each line's chord of the samples' box (grown by d) and the sphere, the same share, at a uniform
///                place on it; their mean length is the workload's
///
/// Source     segments: our choice. Real paths end on surfaces and come from lights: lists near a light are longer.
/// Throws     std::invalid_argument for a sphere out of range, as sim::LineField.
[[nodiscard]] std::vector<sim::Ray> structural_sample(const sim::Sphere& sphere, const Valid<Workload>& workload,
                                                      std::size_t count);

}  // namespace detp::validate
