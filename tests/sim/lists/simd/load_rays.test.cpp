#include "detp/sim/lists/simd/load_rays.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <memory_resource>
#include <vector>

#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"

using namespace detp::sim;
using namespace detp::sim::stream;

TEST_SUITE("known answer") {
  TEST_CASE("the padding behind each list is zero, whatever was in its memory") {
    const auto discs = uniform_discs(Body::cube, 2, 10, 0.1, 1);
    const auto rays = LineField(enclosing_sphere(discs), 1).lines(0, 100);
    const Problem problem = make_problem(rays, discs);
    // Subnormal numbers, with which tests are slow.
    std::vector<float> memory(1 << 16, std::numeric_limits<float>::denorm_min());
    std::pmr::monotonic_buffer_resource resource(memory.data(), memory.size() * sizeof(float),
                                                 std::pmr::null_memory_resource());
    ListArena arena(&resource);
    RayLists lists{arena.allocate(128, true), arena.allocate(128, true), arena.allocate(128, true)};
    for (const RayList& list : lists) REQUIRE(list.a[list.size] != 0);
    static_cast<void>(load_rays(rays, Frame(problem), lists));
    CHECK(size(lists) == 100);
    for (const RayList& list : lists) {
      for (const float* const array : {list.a, list.b, list.p, list.q, list.from, list.to})
        CHECK(std::all_of(array + list.size, array + list.size + padding, [](float value) { return value == 0; }));
      CHECK(std::all_of(list.id + list.size, list.id + list.size + padding, [](auto id) { return id == 0; }));
    }
  }
}
