#pragma once

#include <span>
#include <stop_token>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/technique/technique.hpp"

/// Measures the properties of rays and discs that the models need.
namespace detp::validate {

/// Properties of the mesh from which the samples come; zeros without a mesh.
struct SurfaceFacts {
  double area = 0;         ///< of all triangles
  double edge_length = 0;  ///< mean
};

/// Dimension of a set of points by box counting: the slope of log₂(number of occupied cells) against the number of
/// halvings of the cells, over three levels, clamped to [1, 3]. Counts a stratified sample of at most 8192 points, so
/// its cost does not grow with the scene. Estimates the occupied cells without sampled points from those with one or two
/// (Chao 1984). The finest level is the last at which at least a quarter of further points would come to lie in cells
/// that have sampled points (Good 1953: one minus the share of points that are alone in their cells). Coarser levels are
/// not used, because a body's corners and edges distort the slope there. Returns 3 for fewer than 1024 different points.
///
/// Accuracy   0.1 for 10⁵ points uniform in a cube or on its faces.
[[nodiscard]] double sample_dimension(std::span<const sim::Disc> discs, const std::stop_token& stop = {});

/// The workload of the problem: numbers of rays and discs, S₀, the samples' box and dimension, root mean square disc
/// radius d, classes of radii if the largest is over 1.1 d, mean path length; the
/// central samples if a few lie far from the others (far_discs.hpp). The path length of a ray is its length inside the samples' box grown by d; the mean, over
/// a stratified sample of at most 2048 rays (standard error below 2.2 % if lengths scatter by less than their mean), is 0 if all rays are unbounded lines. Throws sim::Stopped if a stop was requested.
[[nodiscard]] Workload measure(const sim::Problem& problem, const SurfaceFacts& surface = {},
                               const std::stop_token& stop = {});

}  // namespace detp::validate
