#include "detp/sim/ranked/disc_cut.hpp"

#include <doctest/doctest.h>

#include <numeric>

#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/ranked/disc_parts.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

/// Σ (1 + d²/mean d²) of a part, over that of all parts.
double share_of(const PartOfDiscs& part, double mean_square, std::size_t discs) {
  double cost = 0;
  for (const Disc& disc : part.discs) cost += 1 + disc.radius * disc.radius / mean_square;
  return cost / (2 * static_cast<double>(discs));
}

void check_parts(const std::vector<Disc>& discs, std::size_t parts, double tolerance) {
  const DiscsInMemory source(discs);
  const DiscCut cut(source, parts);
  double squares = 0;
  for (const Disc& disc : discs) squares += disc.radius * disc.radius;
  std::vector<int> found(discs.size());
  DiscParts all(source, cut, 0, parts);
  for (std::size_t i = 0; i < parts; ++i) {
    const PartOfDiscs part = all.take(i);
    CHECK(std::ranges::is_sorted(part.numbers));
    bool same = true;
    for (std::size_t k = 0; k < part.discs.size(); ++k) {
      ++found[part.numbers[k]];
      same = same && part.discs[k].centre == discs[part.numbers[k]].centre;
    }
    CHECK(same);
    const double share = share_of(part, squares / static_cast<double>(discs.size()), discs.size());
    CHECK(share * static_cast<double>(parts) == doctest::Approx(1).epsilon(tolerance));
    const PartOfDiscs alone = DiscParts(source, cut, i, 1).take(0);
    CHECK(alone.numbers == part.numbers);
  }
  CHECK(std::ranges::all_of(found, [](int times) { return times == 1; }));
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("each disc is in one part, and parts have equal cost") {
    std::vector<Disc> discs = uniform_discs(Body::cube, 2, 40'000, 0.01, 3);
    for (std::size_t i = 0; i < discs.size() / 2; ++i) discs[i].radius = 0.05;
    for (const std::size_t parts : {1, 2, 3, 16}) check_parts(discs, parts, 0.01);
  }

  TEST_CASE("discs beyond the sample: parts differ by a few per cent") {
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 1'200'000, 0.01, 3);
    REQUIRE(discs.size() > 2 * DiscCut::most_sampled);
    check_parts(discs, 5, 0.01);
  }

  TEST_CASE("discs at one place, and as many parts as discs") {
    const std::vector<Disc> discs(60, Disc{.centre = {1, 2, 3}, .normal = {0, 0, 1}, .radius = 1});
    check_parts(discs, 2, 0.01);
    check_parts(discs, 60, 0.01);
    CHECK_THROWS_AS(DiscCut(DiscsInMemory(discs), 61), std::invalid_argument);
  }
}
