#pragma once

#include <span>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/search/problem.hpp"

namespace detp::validate {

/// The least counts of a search of `rays` rays down any box tree over the problem's discs, as expected from `sample`, a part of
/// these rays. A leaf's box contains the spheres around its discs, so a ray that crosses such a sphere is tested against the
/// disc. 64 discs, evenly spaced in the array, and at most 128 rays are tried.
[[nodiscard]] Counts<double> least_box_tree_counts(const sim::Problem& problem, std::span<const sim::Ray> sample,
                                                   double rays);

}  // namespace detp::validate
