#pragma once

#include "detp/model/vocabulary.hpp"
#include "detp/sim/technique/technique.hpp"

/// What hierarchies of spheres, and of boxes, say of their own search, before any ray.
namespace detp::validate {

/// Expected counts of cell-spheres or sphere-tree on isotropic lines through S₀:
///
///     sphere_tests = n_R Σ P(parent)        copies = n_R Σ P(sphere)        disc_tests = n_R Σ_discs P(innermost
///     sphere) P(sphere) = (r/r₀)² × share of the lines through the sphere that also cross S₀
///
/// with the sums over all spheres of the hierarchy, each built once. As each lies in its parent's, a list holds all
/// rays that cross both its sphere and S₀, and no others. The share is 1 for a sphere in S₀, else both_hit_share. Hits
/// are left at 0. Of a tree of boxes (structural_boxes.hpp) the same sums are taken over boxes, whose root is not
/// tested for, and `rebuilds` are those tests of a node that some ray of a block takes part in.
///
/// Source     our derivation.
/// Valid      lines of the measure μ_ℓ through S₀; discs of any radii.
/// Accuracy   exact, but for sphere-tree where a sphere pokes out of S₀. Boxes, fan-out 4, leaf 16: @uniform, @tree,
///            @courtyard, @cornell, 2000 and 50 000 samples, d 0.25, 1 and 4 % of the scene's side, 400 000 lines:
///            tests of boxes off by 0.25 % in the median, 0.71 % at worst, rays listed by 0.29, 0.84 %, tests of discs
///            by 0.31, 1.1 %, nodes tested by 0.00, 0.81 %; the lines' noise in it (of hits 0.44, 2.3 %).
/// Throws     std::invalid_argument for another technique, or parameters out of range; sim::Stopped if a stop was
///            requested.
[[nodiscard]] Counts<double> structural_hierarchy_counts(const sim::Problem& problem, double rays,
                                                         const Candidate& candidate, const std::stop_token& stop = {});

}  // namespace detp::validate
