#include "detp/sim/files/disc_file.hpp"

#include <doctest/doctest.h>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/search/disc_summary.hpp"
#include "support/disc_ply.hpp"
#include "support/scratch_file.hpp"

using namespace detp;
using namespace detp::sim;
using support::disc_ply;
using support::ScratchFolder;

namespace {

std::vector<Disc> some_discs(std::size_t count) {
  std::vector<Disc> discs = uniform_discs(Body::cube, 2, count, 0.1, 3);
  for (std::size_t i = 0; i < discs.size(); ++i) {
    discs[i].normal *= 1 + 0.001 * static_cast<double>(i % 7);
    discs[i].radius *= 1 + static_cast<double>(i % 3);
  }
  return discs;
}

/// The message of reading the file's discs block by block.
std::string error_of(const std::string& content, std::optional<double> radius = {}) {
  const ScratchFolder folder;
  const std::string path = folder.file("discs.ply", content);
  return support::file_error_of([&] { static_cast<void>(summary_of(*StoredDiscs::open(path, radius))); });
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("discs that are read block by block are those of the whole file, and so is their summary") {
    const ScratchFolder folder;
    const std::string path = folder.file("discs.ply", disc_ply(some_discs(150'000)));
    const std::vector<Disc> whole = read_discs(path, std::nullopt);
    const auto stored = StoredDiscs::open(path, std::nullopt);
    REQUIRE(stored);
    REQUIRE(stored->size() == whole.size());
    CHECK(stored->in_memory().empty());
    std::vector<Disc> block(40'000);
    for (const std::size_t first : {std::size_t{0}, std::size_t{50'001}, whole.size() - block.size()}) {
      stored->read(first, block);
      CHECK(std::memcmp(block.data(), whole.data() + first, block.size() * sizeof(Disc)) == 0);
    }
    const DiscSummary summary = summary_of(*stored);
    const Problem problem = make_problem_without_rays(whole, 1);
    CHECK(summary.enclosing.centre == problem.enclosing().centre);
    CHECK(summary.enclosing.radius == problem.enclosing().radius);
    CHECK(summary.centres.low == problem.centres().low);
    CHECK(summary.centres.high == problem.centres().high);
    CHECK(summary.radii.smallest == problem.radii().smallest);
    CHECK(summary.radii.largest == problem.radii().largest);
    CHECK(summary.radii.rms == problem.radii().rms);
    const std::vector<Disc> sample = sample_of(*stored, 1000);
    REQUIRE(sample.size() == 1000);
    CHECK(sample[999].centre == whole[999 * 150].centre);
    CHECK(sample_of(*stored, 149'999).size() == 75'000);
  }
}

TEST_SUITE("errors") {
  TEST_CASE("only tables whose rows can be read in any order are stored") {
    const ScratchFolder folder;
    CHECK_FALSE(StoredDiscs::open(folder.file("discs.csv", "x,y,z,nx,ny,nz,radius\n0,0,0,0,0,1,1\n"), {}));
  }

  TEST_CASE("errors are those of read_discs, with the disc's place in the file") {
    std::vector<Disc> discs = some_discs(70'000);
    discs[69'000].radius = -1;
    CHECK(error_of(disc_ply(discs))
              .ends_with("discs.ply: vertex 69001 of 70000: radius must be > 0 and finite (got -1)"));
    discs[69'000] = {.centre = {0, 0, 0}, .normal = {0, 0, 0}, .radius = 1};
    CHECK(error_of(disc_ply(discs)).ends_with("the normal is zero; it needs a length"));
    CHECK(error_of(disc_ply({})).ends_with("has no disc; at least one is needed"));
    CHECK(error_of("ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nend_header\n1234")
              .find("no property y") != std::string::npos);
    discs[69'000] = {.centre = {0, 0, 0}, .normal = {0, 0, 1}, .radius = 1e-200};
    const ScratchFolder folder;
    const auto stored = StoredDiscs::open(folder.file("discs.ply", disc_ply(discs)), {});
    CHECK_THROWS_WITH_AS(static_cast<void>(summary_of(*stored)),
                         "disc 69000: radius must be from 1e-100 to 1e100, or its square overflows (got 1e-200)",
                         std::invalid_argument);
  }

  TEST_CASE("a stop request ends reading") {
    const ScratchFolder folder;
    const auto stored = StoredDiscs::open(folder.file("discs.ply", disc_ply(some_discs(10))), {});
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(static_cast<void>(summary_of(*stored, stop.get_token())), Stopped);
  }
}
