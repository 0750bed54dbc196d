#include <doctest/doctest.h>

#include "detp/sim/open/uniform_discs.hpp"
#include "support/attempts.hpp"
#include "support/command.hpp"
#include "support/disc_ply.hpp"
#include "support/sanitized.hpp"
#include "support/scratch_file.hpp"

using detp::support::Finished;
using detp::support::ScratchFolder;
using namespace detp::sim;

namespace {

struct Found {
  Finished finished;
  std::string per_disc;
  std::string pairs;
};

/// `pairs`: also writes them.
Found found(const ScratchFolder& folder, const std::string& line, bool pairs) {
  const std::string per_disc = folder.path("per_disc.csv");
  const std::string pair_file = folder.path("pairs.csv");
  Found result{detp::support::detp(line + " --threads 2 --standard-error --format json --per-disc " + per_disc +
                                   (pairs ? " --pairs " + pair_file : "")),
               {},
               {}};
  CAPTURE(result.finished.err);
  REQUIRE(result.finished.code == 0);
  result.per_disc = detp::support::content_of(per_disc);
  if (pairs) result.pairs = detp::support::content_of(pair_file);
  return result;
}

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("discs of a file that do not fit in memory are searched in parts: the same bytes, and the limit holds") {
    const ScratchFolder folder;
    std::vector<Disc> discs = uniform_discs(Body::cube, 2, 600'000, 0.01, 3);
    for (std::size_t i = 0; i < discs.size(); i += 4) discs[i].radius = 0.02;
    const std::string file = folder.file("discs.ply", detp::support::disc_ply(discs));  // 34 MB
    const std::string rays = folder.path("rays.csv");
    for (const std::string& rest :
         {std::string(" --rays 50000"), std::string(" --rays 20000 --technique octree --field mixed:0.5:0.3:0.2")}) {
      CAPTURE(rest);
      const Found all = found(folder, "run --discs " + file + rest, true);
      const Found parts = found(folder, "run --discs " + file + rest + " --memory-limit 80M", true);
      CHECK(all.finished.err.find("do not fit") == std::string::npos);
      CHECK(parts.finished.err.find("the 600000 discs do not fit in memory") != std::string::npos);
      CHECK(parts.per_disc == all.per_disc);
      CHECK(parts.pairs == all.pairs);
      const auto a = all.finished.json();
      const auto b = parts.finished.json();
      for (const char* same : {"hits", "hits_per_disc", "mean_irradiance", "rays", "photons"})
        CHECK(a.at(same) == b.at(same));
      if (!detp::support::sanitized) {
        CHECK(parts.finished.peak_bytes < 84.0 * (1 << 20));
        CHECK(detp::support::in_attempts(3, [&] {  // a busy machine may not look at the memory in time
          return found(folder, "run --discs " + file + rest, true).finished.peak_bytes > 120.0 * (1 << 20);
        }));
      }
    }
  }

  TEST_CASE("discs in memory whose index does not fit are searched in parts, however few rays there are") {
    const ScratchFolder folder;
    const std::string line = "run --samples 300000 --scene-side 1 --disc-radius 0.003 --rays 100000 --technique octree";
    const Found all = found(folder, line, false);
    const Found parts = found(folder, line + " --memory-limit 70M", false);
    CHECK(parts.per_disc == all.per_disc);
    CHECK(parts.finished.json().at("hits") == all.finished.json().at("hits"));
    if (!detp::support::sanitized) CHECK(parts.finished.peak_bytes < 74.0 * (1 << 20));
  }
}
