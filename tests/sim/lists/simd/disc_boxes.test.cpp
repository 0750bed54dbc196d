#include "detp/sim/lists/simd/disc_boxes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "detp/sim/open/uniform_discs.hpp"
#include "support/instruction_sets.hpp"

using namespace detp::sim;
using namespace detp::sim::stream;

TEST_SUITE("identity") {
  TEST_CASE("the box around discs is that of each disc's reach along the axes, with every instruction set") {
    const auto given = uniform_discs(Body::cube, 1, 100, 0.1, 5);
    std::vector<FloatDisc> discs;
    for (const Disc& disc : given)
      discs.push_back(
          {{static_cast<float>(disc.centre.x), static_cast<float>(disc.centre.y), static_cast<float>(disc.centre.z)},
           {static_cast<float>(disc.normal.x), static_cast<float>(disc.normal.y), static_cast<float>(disc.normal.z)},
           static_cast<float>(disc.radius),
           0});
    for (const std::size_t count : {1, 2, 100}) {
      const std::span<const FloatDisc> some(discs.data(), count);
      FloatBox expected = nothing;
      for (const FloatDisc& disc : some)
        for (int axis = 0; axis < 3; ++axis) {
          const float u = disc.normal[(axis + 1) % 3];
          const float v = disc.normal[(axis + 2) % 3];
          const float reach = disc.radius * std::sqrt(u * u + v * v);
          expected.low[axis] = std::min(expected.low[axis], disc.centre[axis] - reach);
          expected.high[axis] = std::max(expected.high[axis], disc.centre[axis] + reach);
        }
      detp::support::with_each_instruction_set([&] {
        const FloatBox box = box_around(some);
        for (int axis = 0; axis < 3; ++axis) {
          CHECK(box.low[axis] == expected.low[axis]);
          CHECK(box.high[axis] == expected.high[axis]);
        }
      });
    }
  }
}
