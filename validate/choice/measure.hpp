#pragma once

#include <span>
#include <stop_token>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/technique/technique.hpp"

/// Measures what the models need to know about rays and discs.
namespace detp::validate {

/// What a mesh tells about its samples; zeros without a mesh.
struct SurfaceFacts {
  double area = 0;         ///< of all triangles
  double edge_length = 0;  ///< mean
};

/// Dimension of a set of points by box counting: the slope of log₂(occupied cells) over the three finest levels of
/// halving at which an occupied cell still holds four points on average; least squares, clamped to [1, 3]. (Coarser
/// levels would be dominated by the corners and edges of a body.) 3 for fewer than 4096 points, which are too few for
/// three such levels.
///
/// Accuracy   0.1 for 10⁵ points uniform in a cube or on its faces.
[[nodiscard]] double sample_dimension(std::span<const sim::Disc> discs, const std::stop_token& stop = {});

/// The workload of the problem: counts, S₀, the samples' box and dimension, root mean square disc radius, mean path
/// length (unbounded lines among segments count with the mean chord of S₀, 4r₀/3).
[[nodiscard]] Workload measure(const sim::Problem& problem, const SurfaceFacts& surface = {},
                               const std::stop_token& stop = {});

}  // namespace detp::validate
