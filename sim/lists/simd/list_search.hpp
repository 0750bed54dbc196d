#pragma once

#include "block_search.hpp"

/// Operations on one list with one sphere or one disc, compiled for each instruction set.
namespace detp::sim::stream {

/// Lists the rays of class k that may come within the sphere. `inside` must have room for all of `around`.
void cull_sphere(const BlockSearch& block, int k, const FloatSphere& sphere, const RayList& around, RayList& inside,
                 Worker& worker);

/// Finds the hits of the discs at places first … first + count - 1 by the listed rays of class k.
void test_discs(const BlockSearch& block, int k, std::uint32_t first, std::uint32_t count, const RayList& rays,
                Worker& worker);

}  // namespace detp::sim::stream
