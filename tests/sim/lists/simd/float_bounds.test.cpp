#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "support/float_shares.hpp"
#include "support/hard_scene.hpp"

using namespace detp::sim;
using namespace detp::support;

namespace {

/// A kind of scenes: a hard family, discs that touch corners, or isotropic lines.
struct Kind {
  std::string name;
  std::size_t number;
};

std::vector<Kind> kinds() {
  std::vector<Kind> list;
  for (std::size_t i = 0; i < families.size(); ++i) list.push_back({std::string(families[i].name), i});
  list.push_back({"corners", families.size()});
  list.push_back({"isotropic", families.size() + 1});
  return list;
}

HardScene scene_of(const Kind& kind, std::uint64_t index, std::size_t discs, std::size_t rays) {
  if (kind.number < families.size()) return hard_scene(kind.number, index, discs, rays);
  if (kind.number == families.size()) return scene_at_corners(index, discs, rays);
  HardScene scene{uniform_discs(Body::cube, 2, discs, 0.3, index), {}};
  scene.rays = LineField(enclosing_sphere(scene.discs), index).lines(0, rays);
  return scene;
}

Shares measure(const Kind& kind, std::uint64_t scenes, std::size_t discs, std::size_t rays) {
  Shares shares;
  for (std::uint64_t i = 0; i < scenes; ++i) {
    const HardScene scene = scene_of(kind, i, discs, rays);
    const Problem problem = make_problem(scene.rays, scene.discs);
    const Floats floats(problem);
    Measure<false>(floats, shares).all();
    Measure<true>(floats, shares).all();
  }
  return shares;
}

void check_all_kinds(std::uint64_t scenes, std::size_t rays, bool print) {
  Shares most;
  for (const Kind& kind : kinds()) {
    CAPTURE(kind.name);
    const Shares shares = measure(kind, scenes, 10, rays);
    CHECK(shares.outside == 0);
    CHECK(shares.hits > shares.decisions / 200);
    for (const auto share : {&Shares::rim, &Shares::ends, &Shares::box, &Shares::sphere}) {
      CHECK(shares.*share < 1);
      most.*share = std::max(most.*share, shares.*share);
    }
    most.widest = std::max(most.widest, shares.widest);
    if (print)
      MESSAGE(
          fmt::format("{:12} {:9} decisions {:8} hits | rim {:.3f} wrong {:7} of the band {:.3f} | ends {:.3f} | "
                      "box {:.3f} | sphere {:.3f}",
                      kind.name, shares.decisions, shares.hits, shares.rim, shares.wrong, shares.widest, shares.ends,
                      shares.box, shares.sphere));
  }
  // The proof adds up errors that never occur together, so the measured shares of the bounds are small. But they are
  // well above noise.
  CHECK(most.rim > 0.03);
  CHECK(most.ends > 0.03);
  CHECK(most.box > 0.005);
  CHECK(most.sphere > 0.03);
  CHECK(most.widest > 0.03);
}

/// The difference between two counts of hits, summed over the discs.
std::uint64_t differences(const std::vector<std::uint64_t>& some, const std::vector<std::uint64_t>& others) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < some.size(); ++i)
    sum += static_cast<std::uint64_t>(std::abs(static_cast<std::int64_t>(some[i] - others[i])));
  return sum;
}

/// Number of wrong hits of the kernels if bands or margins are `times` as wide.
template <class Find>
std::uint64_t count_wrong(const std::vector<Kind>& some, const Find& find, float times) {
  std::uint64_t sum = 0;
  for (const Kind& kind : some) {
    const HardScene scene = scene_of(kind, 7, 40, 8000);
    const Problem problem = make_problem(scene.rays, scene.discs);
    const Outcome expected =
        run(problem, {detp::Technique::brute_force, detp::BruteForceParameters{}}, {.engine = detp::Engine::plain});
    sum += differences(find(Floats(problem), times), expected.hits);
  }
  return sum;
}

const std::vector<Kind> near_the_rim{{"tangent", 0}, {"grazing", 1}};
const std::vector<Kind> at_corners{{"corners", families.size()}};

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("compared with long double, the float errors are smaller than the bands and margins") {
    check_all_kinds(2, 300, false);
  }

  TEST_CASE("without bands, or with a fiftieth of them, the kernels decide wrongly; with the whole bands never") {
    CHECK(count_wrong(near_the_rim, hits_with_band, 0) > 100);
    CHECK(count_wrong(near_the_rim, hits_with_band, 0.02F) > 5);
    CHECK(count_wrong(near_the_rim, hits_with_band, 1) == 0);
  }

  TEST_CASE("boxes lose hits without margins, spheres with negative margins; with the whole margins neither") {
    CHECK(count_wrong(at_corners, hits_in_boxes, 0) > 20);
    CHECK(count_wrong(at_corners, hits_in_spheres, -0.2F) > 0);
    for (const auto find : {hits_in_boxes, hits_in_spheres}) {
      CHECK(count_wrong(at_corners, find, -1) > 50);
      CHECK(count_wrong(at_corners, find, 1) == 0);
    }
  }
}

TEST_SUITE("statistical") {
  TEST_CASE("millions of decisions in floats: none is wrong outside the bands, no hit is beyond the margins") {
    check_all_kinds(100, 1000, true);
    for (const float times : {0.0F, 0.01F, 0.02F, 0.03F, 0.05F, 0.1F, 1.0F})
      MESSAGE(fmt::format("bands and margins times {:4}: wrong {:6} by bands, {:6} in boxes, {:6} in spheres", times,
                          count_wrong(near_the_rim, hits_with_band, times),
                          count_wrong(at_corners, hits_in_boxes, times),
                          count_wrong(at_corners, hits_in_spheres, times)));
  }
}
