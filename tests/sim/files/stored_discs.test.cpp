#include "detp/sim/files/disc_file.hpp"

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

#include "../ranks/thread_ranks.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/files/ray_file.hpp"
#include "detp/sim/files/stored_rays.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/search/disc_summary.hpp"
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

constexpr std::size_t many = 150'000;  // three chunks

template <class Number>
void put(Number number, std::endian order, std::string& to) {
  char bytes[sizeof(number)];
  std::memcpy(bytes, &number, sizeof(number));
  if (order != std::endian::native) std::reverse(bytes, bytes + sizeof(number));
  to.append(bytes, sizeof(number));
}

/// Paths of one to four rays, and one of 70 000: longer than a chunk.
std::vector<std::uint32_t> some_photons() {
  std::vector<std::uint32_t> photons;
  for (std::uint32_t photon = 5; photons.size() < many; photon += 3) {
    const auto rays =
        static_cast<std::size_t>(photon == 50 * 3 + 5 ? 70'000 : 1 + 4 * uniform4(1, Stream::tests, photon)[0]);
    photons.insert(photons.end(), rays, photon);
  }
  photons.resize(many);
  return photons;
}

/// A binary PLY file; without numbers if there are no photons.
std::string ply(const std::vector<std::uint32_t>& photons, std::endian order, std::size_t rays = many) {
  std::string text = std::string("ply\nformat binary_") + (order == std::endian::little ? "little" : "big") +
                     "_endian 1.0\nelement other 2\nproperty uchar flag\nelement vertex " + std::to_string(rays) + "\n";
  for (const char* const name : {"ox", "oy", "oz", "dx", "dy", "dz"})
    text += std::string("property double ") + name + "\n";
  text += "property float length\n";
  if (!photons.empty()) text += "property uint photon\n";
  text += "end_header\n\x01\x02";
  for (std::size_t i = 0; i < rays; ++i) {
    const auto a = uniform4(2, Stream::tests, i);
    const auto b = uniform4(3, Stream::tests, i);
    for (const double number : {a[0], a[1], a[2], b[0] - 0.5, b[1] - 0.5, b[2] + 0.1}) put(number, order, text);
    put(static_cast<float>(a[3]), order, text);
    if (!photons.empty()) put(photons[i], order, text);
  }
  return text;
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

  TEST_CASE("rays that are read block by block are those of the whole file") {
    for (const bool numbered : {true, false})
      for (const std::endian order : {std::endian::little, std::endian::big}) {
        const ScratchFolder folder;
        const std::string path =
            folder.file("rays.ply", ply(numbered ? some_photons() : std::vector<std::uint32_t>{}, order));
        const RayFile whole = read_rays(path);
        const auto stored = StoredRays::open(path);
        REQUIRE(stored);
        REQUIRE(stored->size() == many);
        CHECK(stored->numbered() == numbered);
        CHECK(stored->photons() == (numbered ? whole.paths.photons.back() + 1 : many));
        std::vector<Ray> block(40'000);
        BesideRays beside;
        const std::vector<std::uint64_t>& photons = beside.photons;
        for (const std::size_t first : {std::size_t{0}, std::size_t{50'001}, many - block.size()}) {
          stored->read_all(first, block, beside);
          CHECK(std::memcmp(block.data(), whole.paths.rays.data() + first, block.size() * sizeof(Ray)) == 0);
          if (numbered)
            CHECK(std::equal(photons.begin(), photons.end(), whole.paths.photons.begin() + std::ptrdiff_t(first)));
          CHECK(photons.empty() != numbered);
        }
        double farthest = 0;
        for (const Ray& ray : whole.paths.rays) farthest = std::max(farthest, glm::length(ray.origin));
        CHECK(stored->farthest_from({0, 0, 0}) >= farthest);
        CHECK(stored->farthest_from({0, 0, 0}) < 1.01 * std::sqrt(3));
        if (!numbered) continue;
        const auto& numbers = whole.paths.photons;
        for (const std::uint64_t photon : {std::uint64_t{0}, std::uint64_t{49}, std::uint64_t{50}, std::uint64_t{51},
                                           numbers[65'535], numbers[65'536], numbers.back(), numbers.back() + 1})
          CHECK(stored->first_ray_of(photon) ==
                static_cast<std::uint64_t>(std::ranges::lower_bound(numbers, photon) - numbers.begin()));
        for (const std::uint64_t first : {std::uint64_t{0}, stored->first_ray_of(50), stored->first_ray_of(51)})
          for (const std::uint64_t most : {1, 7, 30'000, 100'000}) {
            const std::uint64_t end = stored->block_end(first, most);
            CHECK(end > first);
            CHECK((end == many || numbers[end] != numbers[end - 1]));
            CHECK((end - first <= most || numbers[end - 1] == numbers[first]));
          }
      }
  }

  TEST_CASE("ranks look through the file together") {
    const ScratchFolder folder;
    const std::string path = folder.file("rays.ply", ply(some_photons(), std::endian::little));
    const auto alone = StoredRays::open(path);
    const auto thrown = on_ranks(2, [&](Ranks& ranks) {
      const auto together = StoredRays::open(path, {}, &ranks);
      CHECK(together->photons() == alone->photons());
      CHECK(together->first_ray_of(60) == alone->first_ray_of(60));
      CHECK(together->farthest_from({1, 2, 3}) == alone->farthest_from({1, 2, 3}));
    });
    for (const std::exception_ptr& one : thrown) CHECK_FALSE(one);
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

TEST_SUITE("bad input") {
  TEST_CASE("files that cannot be read in any order are left to read_rays; wrong rays are named") {
    const ScratchFolder folder;
    CHECK_FALSE(StoredRays::open(folder.file("rays.csv", "ox,oy,oz,dx,dy,dz\n0,0,0,0,0,1\n")));
    REQUIRE(::mkfifo(folder.path("pipe.ply").c_str(), 0600) == 0);  // its header may be read once
    CHECK_FALSE(StoredRays::open(folder.path("pipe.ply")));
    std::vector<std::uint32_t> falling = some_photons();
    falling.back() = 1;
    CHECK_FALSE(StoredRays::open(folder.file("falling.ply", ply(falling, std::endian::little))));
    const std::string good = ply(some_photons(), std::endian::little, 1000);
    CHECK(StoredRays::open(folder.file("good.ply", good))->size() == 1000);
    CHECK(support::file_error_of([&] {
            (void)StoredRays::open(folder.file("short.ply", good.substr(0, good.size() - 1)));
          }).find("ends early") != std::string::npos);
    std::string zero = good;
    const std::size_t row = 6 * sizeof(double) + sizeof(float) + sizeof(std::uint32_t);
    std::fill_n(zero.end() - static_cast<std::ptrdiff_t>(row) + 3 * sizeof(double), 3 * sizeof(double), '\0');
    CHECK(support::file_error_of([&] {
            (void)StoredRays::open(folder.file("zero.ply", zero));
          }).find("vertex 1000 of 1000: the direction is zero") != std::string::npos);
    CHECK(support::file_error_of([&] {
            (void)StoredRays::open(folder.file("none.ply", ply(some_photons(), std::endian::little, 0)));
          }).find("no ray") != std::string::npos);
  }
}
