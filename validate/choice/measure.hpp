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
/// halvings of the cells, by least squares, clamped to [1, 3]. Uses the three finest levels at which an occupied cell
/// holds at least four points on average. (On coarser levels, corners and edges of a body distort the slope.) Returns 3
/// for fewer than 4096 points, which are too few for three such levels. Of more than 131 072 points, counts a stratified
/// sample of that size.
///
/// Accuracy   0.1 for 10⁵ points uniform in a cube or on its faces.
[[nodiscard]] double sample_dimension(std::span<const sim::Disc> discs, const std::stop_token& stop = {});

/// The workload of the problem: numbers of rays and discs, S₀, the samples' box and dimension, root mean square disc
/// radius d, classes of radii if the largest is over 1.1 d, mean path length; the
/// central samples if a few lie far from the others (far_discs.hpp). The path length of a ray is its length inside the samples' box grown by d; the mean, over
/// a stratified sample of at most 16 384 rays, is 0 if all rays are unbounded lines. Throws sim::Stopped if a stop was requested.
[[nodiscard]] Workload measure(const sim::Problem& problem, const SurfaceFacts& surface = {},
                               const std::stop_token& stop = {});

}  // namespace detp::validate
