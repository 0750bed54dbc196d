#include "detp/sim/base/page_pool.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <thread>
#include <vector>

#include "detp/sim/base/memory.hpp"

using namespace detp::sim;

namespace {

struct Block {
  std::uint32_t* start;
  std::size_t words;
  std::uint32_t mark;
};

/// Takes and returns blocks at random, and checks that each has what was written to it.
bool blocks_are_apart(std::uint32_t seed) {
  std::mt19937 draw(seed);
  std::vector<Block> blocks;
  bool good = true;
  const auto give_back = [&](std::size_t i) {
    const Block& block = blocks[i];
    good &= std::all_of(block.start, block.start + block.words, [&](std::uint32_t word) { return word == block.mark; });
    page_pool().deallocate(block.start, block.words * sizeof(std::uint32_t), 64);
    blocks.erase(blocks.begin() + static_cast<std::ptrdiff_t>(i));
  };
  for (std::uint32_t mark = 0; mark < 400; ++mark) {
    const std::size_t words = 1 + draw() % (mark % 8 == 0 ? 1'000'000 : 40'000);
    auto* const start = static_cast<std::uint32_t*>(page_pool().allocate(words * sizeof(std::uint32_t), 64));
    good &= reinterpret_cast<std::uintptr_t>(start) % 64 == 0;
    std::fill_n(start, words, mark);
    blocks.push_back({start, words, mark});
    while (blocks.size() > 12) give_back(draw() % blocks.size());
  }
  while (!blocks.empty()) give_back(0);
  return good;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("blocks of the pool do not overlap, for one thread and for several") {
    CHECK(blocks_are_apart(1));
    std::vector<char> good(3, 0);
    std::vector<std::thread> threads;
    for (std::uint32_t i = 0; i < good.size(); ++i)
      threads.emplace_back([&good, i] { good[i] = blocks_are_apart(i + 2) ? 1 : 0; });
    for (std::thread& thread : threads) thread.join();
    CHECK(good == std::vector<char>(3, 1));
  }

  TEST_CASE(
      "the pool keeps what is freed for the same request; no more than its limit, and nothing under a memory limit") {
    constexpr std::size_t bytes = std::size_t{5} << 20;
    release_kept_pages();
    const std::size_t before = kept_bytes();
    void* const first = page_pool().allocate(bytes);
    page_pool().deallocate(first, bytes);
    const std::size_t kept = kept_bytes();
    CHECK((kept == 0 || kept >= before + bytes));  // 0: a sanitizer wants all from the heap
    void* const second = page_pool().allocate(bytes);
    if (kept > 0) CHECK(second == first);
    page_pool().deallocate(second, bytes);
    CHECK(kept_bytes() == kept);
    page_pool().deallocate(page_pool().allocate(2 * most_kept_bytes), 2 * most_kept_bytes);
    CHECK(kept_bytes() <= most_kept_bytes);
    set_memory_limit(1e15);
    page_pool().deallocate(page_pool().allocate(bytes), bytes);
    CHECK(kept_bytes() <= before);
    set_memory_limit({});
  }
}
