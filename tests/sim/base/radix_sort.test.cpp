#include "detp/sim/base/radix_sort.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>

#include "detp/sim/base/sorted_runs.hpp"
#include "detp/sim/geometry/random.hpp"

using namespace detp::sim;
using namespace detp;

namespace {

std::vector<KeyedIndex> keyed(std::uint64_t mask, std::uint64_t constant) {
  std::vector<KeyedIndex> entries;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    const auto words = bits4(6, Stream::tests, i);
    entries.push_back({((std::uint64_t{words[0]} << 32 | words[1]) & mask) | constant, i});
  }
  return entries;
}

bool same(const KeyedIndex& a, const KeyedIndex& b) { return a.key == b.key && a.index == b.index; }

/// `count` numbers in runs of random lengths; some runs are empty.
void check_merged(std::size_t count) {
  CAPTURE(count);
  std::vector<std::uint64_t> expected;
  SortedRuns<std::uint64_t> runs;
  for (std::size_t run = 0; expected.size() < count; ++run) {
    const auto random = uniform4(7, Stream::tests, run);
    std::vector<std::uint64_t> numbers(std::min<std::size_t>(
        count - expected.size(), static_cast<std::size_t>(random[0] * (2 + static_cast<double>(count) / 4))));
    for (std::size_t i = 0; i < numbers.size(); ++i)
      numbers[i] = static_cast<std::uint64_t>(1e15 * uniform4(8 + run, Stream::tests, i)[0]);
    std::ranges::sort(numbers);
    runs.begin_run();
    const std::size_t half = numbers.size() / 2;
    runs.append(std::span<const std::uint64_t>(numbers).first(half));
    runs.append(std::span<const std::uint64_t>(numbers).subspan(half));
    expected.insert(expected.end(), numbers.begin(), numbers.end());
  }
  runs.begin_run();
  std::ranges::sort(expected);
  CHECK(runs.size() == expected.size());
  for (int again = 0; again < 2; ++again) {
    SortedRuns<std::uint64_t>::Reader reader(runs);
    std::vector<std::uint64_t> merged;
    std::uint64_t number = 0;
    while (reader.next(number)) merged.push_back(number);
    CHECK_FALSE(reader.next(number));
    CHECK(merged == expected);
  }
}

/// Sets TMPDIR, and restores it.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const char* folder) {
    if (const char* before = std::getenv("TMPDIR")) before_ = before;
    ::setenv("TMPDIR", folder, 1);
  }
  ~TemporaryFolder() { before_ ? ::setenv("TMPDIR", before_->c_str(), 1) : ::unsetenv("TMPDIR"); }

 private:
  std::optional<std::string> before_;
};

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("the result is that of a stable sort by key, whichever digits differ") {
    // Keys that differ in all 64 bits; few distinct keys, so that there are ties; keys with equal digits below, between
    // and above the digits that differ; equal keys.
    for (const auto& [mask, constant] :
         {std::pair{~0ULL, 0ULL}, std::pair{0x300ULL, 0ULL}, std::pair{0xff00'00ff'0000ULL, 0x1200'0000'0000'0034ULL},
          std::pair{0ULL, 7ULL}}) {
      std::vector<KeyedIndex> entries = keyed(mask, constant);
      std::vector<KeyedIndex> expected = entries;
      std::stable_sort(expected.begin(), expected.end(),
                       [](const KeyedIndex& a, const KeyedIndex& b) { return a.key < b.key; });
      radix_sort(entries);
      CHECK(std::equal(entries.begin(), entries.end(), expected.begin(), expected.end(), same));
    }
    std::vector<KeyedIndex> none;
    radix_sort(none);
    CHECK(none.empty());
  }

  TEST_CASE("bits above `bits` are ignored") {
    std::vector<KeyedIndex> entries{{0x1'0001, 0}, {0x0'0002, 1}, {0x0'0001, 2}};
    radix_sort(entries, 16);
    CHECK(entries[0].index == 0);
    CHECK(entries[1].index == 2);
    CHECK(entries[2].index == 1);
  }

  TEST_CASE("merged runs are all records, sorted: in memory, and in a file") {
    for (const std::size_t count : {0, 1, 1000, 131'072, 131'073, 500'000}) check_merged(count);
  }
}

TEST_SUITE("errors") {
  TEST_CASE("a folder in which no temporary file can be made is named") {
    const TemporaryFolder none("/nowhere");
    std::vector<std::byte> bytes(SpillFile::most_in_memory);
    SpillFile file;
    file.append(bytes);  // needs no file
    CHECK_THROWS_WITH_AS(file.append(std::span<const std::byte>(bytes).first(1)),
                         "a temporary file in /nowhere cannot be made: No such file or directory "
                         "(TMPDIR names another folder)",
                         std::runtime_error);
  }
}
