#pragma once

#include <vector>

#include "pilot.hpp"

/// Chooses by the structure that the discs build, without the rays of the run.
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

/// Structural rigor: choose_by_pilot with a structural_sample instead of rays of the run. So the prediction has a standard
/// error, takes the same time for any number of rays, and uses no rays that will be searched. The number of hits is the
/// expected one (model::expected_hits).
///
/// The problem needs no rays, but its farthest() must be at least the radius of S0, because lines start anywhere in S0
/// (sim::make_problem_without_rays). Throws as choose_by_pilot, and std::invalid_argument for another problem.
[[nodiscard]] PilotChoice choose_by_structure(const sim::Problem& problem, const Valid<Workload>& workload,
                                              const Valid<CostTable>& costs, const PilotOptions& options = {});

}  // namespace detp::validate
