#include "detp/sim/base/radix_sort.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "detp/sim/geometry/random.hpp"

using namespace detp::sim;

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
}
