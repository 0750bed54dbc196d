#include "detp/sim/effects/sample_dimension.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/uniform_discs.hpp"

using namespace detp::sim;

namespace {

SampleDimension dimension_of(std::span<const Disc> discs, std::uint64_t seed = 1) {
  return sample_dimension(
      curve_sample(discs, stratified_sample(discs.size(), 8192, seed, Stream::evidence), {.radius = 2}).keys);
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("the dimension of uniform samples is that of their body, to 0.1") {
    CHECK(std::abs(dimension_of(uniform_discs(Body::cube, 2, 100'000, 0.01, 1)).value - 3) < 0.1);
    CHECK(std::abs(dimension_of(uniform_discs(Body::cube_faces, 2, 100'000, 0.01, 1)).value - 2) < 0.1);
  }

  TEST_CASE("points on a line have dimension 1; a few points count as a volume") {
    auto discs = uniform_discs(Body::cube, 2, 50'000, 0.01, 1);
    for (Disc& disc : discs) disc.centre.y = disc.centre.z = 0;
    CHECK(std::abs(dimension_of(discs).value - 1) < 0.1);
    CHECK(dimension_of(std::span(discs).first(100)).value == 3);
  }
}

TEST_SUITE("statistical") {
  TEST_CASE("the standard error of the dimension is that of repeated samples, within a factor of two") {
    // on the faces of a cube, because a volume's dimension is often clamped at 3
    const auto discs = uniform_discs(Body::cube_faces, 2, 200'000, 0.01, 1);
    constexpr int samples = 60;
    double mean = 0;
    double squares = 0;
    double stated = 0;
    for (int seed = 1; seed <= samples; ++seed) {
      const SampleDimension found = dimension_of(discs, static_cast<std::uint64_t>(seed));
      mean += found.value / samples;
      squares += found.value * found.value / samples;
      stated += found.standard_error / samples;
    }
    const double spread = std::sqrt(std::max(0.0, squares - mean * mean));
    INFO("spread ", spread, ", stated ", stated);
    CHECK(stated > 0.5 * spread);
    CHECK(stated < 2 * spread);
  }
}
