#include "detp/sim/base/scratch.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <vector>

using namespace detp::sim;

TEST_SUITE("scratch") {
  TEST_CASE("What is freed is handed out again, so that the same requests take no more memory") {
    Scratch scratch;
    std::size_t held = 0;
    for (int round = 0; round < 3; ++round) {
      scratch.begin();
      std::vector<void*> blocks;
      for (const std::size_t bytes : {1UL, 64UL, 65UL, 80UL, 81UL, 1000UL, 123'456UL, 5'000'000UL})
        blocks.push_back(scratch.allocate(bytes));
      std::size_t i = 0;
      for (const std::size_t bytes : {1UL, 64UL, 65UL, 80UL, 81UL, 1000UL, 123'456UL, 5'000'000UL})
        scratch.deallocate(blocks[i++], bytes);
      if (round == 0) held = scratch.bytes();
      CHECK(scratch.bytes() == held);
    }
  }

  TEST_CASE("Blocks hold what was asked for, take at most a quarter more, and begin on a cache line") {
    for (std::size_t bytes = 1; bytes < 10'000; ++bytes) {
      Scratch scratch;
      void* const block = scratch.allocate(bytes);
      CHECK(reinterpret_cast<std::uintptr_t>(block) % 64 == 0);
      CHECK(scratch.bytes() >= bytes);
      if (bytes > 64) CHECK(static_cast<double>(scratch.bytes()) <= 1.25 * static_cast<double>(bytes));
      scratch.deallocate(block, bytes);
    }
  }

  TEST_CASE("Memory that later searches do not need is freed") {
    Scratch scratch;
    scratch.begin();
    scratch.deallocate(scratch.allocate(10'000'000), 10'000'000);
    scratch.begin();
    scratch.deallocate(scratch.allocate(1000), 1000);
    CHECK(scratch.bytes() > 10'000'000);
    scratch.begin();
    CHECK(scratch.bytes() == 0);
  }

  TEST_CASE("An object made in a resource is destroyed, and its memory returned, through its base") {
    struct Base {
      virtual ~Base() = default;
    };
    struct Large final : Base {
      explicit Large(int& destroyed) : count(destroyed) {}
      ~Large() override { ++count; }
      int& count;
      double room[100]{};
    };
    Scratch scratch;
    int destroyed = 0;
    make_in<Base, Large>(scratch, destroyed).reset();
    CHECK(destroyed == 1);
    const std::size_t held = scratch.bytes();
    CHECK(held >= sizeof(Large));
    make_in<Base, Large>(scratch, destroyed).reset();
    CHECK(scratch.bytes() == held);
  }
}
