#include "detp/validate/bench/peer/embree_peer.hpp"

#include <doctest/doctest.h>

#include <cfloat>
#include <cmath>

#include "detp/sim/technique/technique.hpp"
#include "support/run_support.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

// Number of rays: more than one block, and not divisible by the number of rays in a packet or a stream.
constexpr std::uint64_t odd_count = 4096 + 1003;

struct Data {
  std::vector<sim::Disc> discs = support::mixed_discs(200);
  std::vector<sim::Ray> rays = support::mixed_rays(odd_count);
  sim::Outcome right = sim::run(sim::make_problem(rays, discs), Candidate{});
};

const Data& data() {
  static const Data made;
  return made;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("Embree finds the hits and the power of brute force in each of its modes, to single precision") {
    const EmbreePeer embree(1);
    REQUIRE(data().right.total_hits > 1000);
    for (const EmbreeMode& mode : all_embree_modes()) {
      CAPTURE(describe(mode));
      const PeerOutcome found = embree.run(data().rays, data().discs, mode);
      CHECK_FALSE(found.stopped);
      std::uint64_t wrong = 0;
      bool same_power = true;
      for (std::size_t i = 0; i < data().discs.size(); ++i) {
        const std::uint64_t hits = data().right.hits[i];
        wrong += std::max(hits, found.hits[i]) - std::min(hits, found.hits[i]);
        const double power = data().right.irradiance[i];
        if (hits == found.hits[i]) same_power = same_power && std::abs(found.irradiance[i] - power) <= 1e-9 * power;
      }
      CHECK(wrong <= 2);
      CHECK(same_power);
    }
  }

  TEST_CASE("two threads find the same as one") {
    const EmbreePeer one(1);
    const EmbreePeer two(2);
    const EmbreeMode mode{EmbreeQuery::occluded, EmbreeRays::stream_of_packets, EmbreeQuality::low, true};
    CHECK(two.run(data().rays, data().discs, mode).hits == one.run(data().rays, data().discs, mode).hits);
  }

  TEST_CASE("all modes have different names") {
    std::vector<std::string> names;
    for (const EmbreeMode& mode : all_embree_modes()) names.push_back(describe(mode));
    std::sort(names.begin(), names.end());
    CHECK(names.size() == 60);
    CHECK(std::adjacent_find(names.begin(), names.end()) == names.end());
  }

  TEST_CASE("denormal numbers work as before after Embree has run") {
    (void)EmbreePeer(1).run(data().rays, data().discs, {});
    volatile double smallest = DBL_MIN;
    CHECK(smallest / 2 > 0);
  }

  TEST_CASE("a stopped run says so") {
    std::stop_source stop;
    stop.request_stop();
    CHECK(EmbreePeer(1).run(data().rays, data().discs, {}, stop.get_token()).stopped);
  }
}
