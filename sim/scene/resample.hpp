#pragma once

#include <cstdint>

#include "mesh.hpp"

namespace detp::sim {

/// A random subset of `count` samples, in the same order; `count` is at most samples.size(). All subsets are equally
/// likely. Throws Stopped if a stop was requested.
[[nodiscard]] std::vector<Sample> random_subset(const std::vector<Sample>& samples, std::size_t count,
                                                std::uint64_t seed, const std::stop_token& stop = {});

/// Adds `count` samples distributed by area over the triangles, with the triangles' normals. Adds none to a mesh whose
/// triangles have no area. Throws Stopped if a stop was requested.
void add_by_area(std::vector<Sample>& samples, const Mesh& mesh, std::size_t count, std::uint64_t seed,
                 const std::stop_token& stop = {});

}  // namespace detp::sim
