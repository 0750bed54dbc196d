#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include <cstdint>
#include <span>
#include <vector>

#include "detp/sim/base/embree.hpp"
#include "embree_peer.hpp"

/// Rays through Embree's scene of discs.
namespace detp::validate {

/// Stores four floats at once, to an address divisible by 16. Embree loads the four floats as a vector. Its
/// documentation warns that four single stores would stall this load.
inline void store_four(float* to, float a, float b, float c, float d) {
#if defined(__SSE2__)
  _mm_store_ps(to, _mm_setr_ps(a, b, c, d));
#else
  to[0] = a;
  to[1] = b;
  to[2] = c;
  to[3] = d;
#endif
}

/// The sums of one disc. They lie together, so that a hit touches only one cache line.
struct DiscTally {
  double power = 0;
  std::uint32_t hits = 0;
};

/// A number of successive rays.
struct RayBlock {
  std::size_t first;
  std::size_t last;  ///< behind the last ray
};

/// Traces a block of the rays and adds their hits to `tallies`, which has one element for each disc. `around` is a sphere around all
/// discs. Thread-safe if each thread has its own tallies.
void trace(RTCScene scene, std::span<const sim::Ray> rays, const sim::Sphere& around, const EmbreeMode& mode,
           const RayBlock& block, std::vector<DiscTally>& tallies);

}  // namespace detp::validate
