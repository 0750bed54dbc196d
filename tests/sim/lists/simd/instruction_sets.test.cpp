#include "detp/sim/lists/simd/instruction_sets.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory_resource>
#include <string>
#include <vector>

#include "detp/sim/lists/simd/disc_boxes.hpp"
#include "detp/sim/lists/simd/list_search.hpp"
#include "detp/sim/lists/simd/ray_blocks.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "support/candidates.hpp"
#include "support/hard_scene.hpp"
#include "support/machine.hpp"
#include "support/same_bytes.hpp"

using namespace detp;
using namespace detp::sim;
using namespace detp::support;
using namespace detp::sim::stream;

namespace {

/// Lines and segments of the hard families, except those so far away that floats decide little. All are aimed at the
/// discs of one scene. Their powers are all 1, or span ten decades.
HardScene mixed_scene(bool equal_powers) {
  HardScene scene = hard_scene(0, 0, 60, 1);
  scene.rays.clear();
  for (const std::size_t family : {0, 1, 2, 7, 8}) {
    RandomSequence random(500 + family, equal_powers ? 0 : 1);
    for (std::size_t i = 0; i < 600; ++i) {
      scene.rays.push_back(hard_ray(families[family], random, scene.discs[i % scene.discs.size()]));
      if (!equal_powers) scene.rays.back().power = std::pow(10, 10 * random.uniform());
    }
  }
  return scene;
}

/// Runs every instruction set that the machine has.
void check_same_bytes_by_all(const Problem& problem) {
  const Outcome expected = truth_of(problem);
  CHECK(expected.total_hits > 500);
  with_each_instruction_set([&] {
    for (const bool pairs : {true, false}) check_same_by_all(problem, expected, {float_candidates()}, {.pairs = pairs});
  });
}

/// The names, such as "AVX2 AVX3", of the instruction sets that the machine has (or lacks).
std::string names(bool had) {
  std::string list;
  for (const stream::InstructionSet& set : stream::compiled_instruction_sets())
    if (set.here == had) list += fmt::format("{}{}", list.empty() ? "" : " ", set.name);
  return list;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("hits, irradiance and pairs are the same bytes with every instruction set and in doubles") {
    const std::string best = stream::instruction_set();
    MESSAGE("instruction sets tried: ", names(true));
    WARN_MESSAGE(names(false).empty(), "not tried, for this machine lacks them: ", names(false));
    for (const bool equal_powers : {true, false}) {
      const HardScene scene = mixed_scene(equal_powers);
      for (const bool front : {false, true}) check_same_bytes_by_all(make_problem(scene.rays, scene.discs, front));
    }
    CHECK(stream::instruction_set() == best);
  }

  TEST_CASE("an instruction set that the machine lacks is refused") {
    const auto use = [](const std::string& name) { const stream::OnlyInstructionSet only(name); };
    CHECK_THROWS_AS(use("AVX"), std::invalid_argument);
    for (const stream::InstructionSet& set : stream::compiled_instruction_sets())
      if (!set.here) CHECK_THROWS_AS(use(set.name), std::invalid_argument);
  }

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
