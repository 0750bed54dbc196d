#include "detp/sim/base/memory.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <vector>

#include "detp/sim/base/scratch.hpp"
#include "support/scratch_file.hpp"

using namespace detp::sim;
using doctest::Contains;

namespace {

/// A temporary folder of made-up cgroups.
class Groups {
 public:
  void write(const std::filesystem::path& file, const char* content) const {
    std::filesystem::create_directories((root() / file).parent_path());
    std::ofstream(root() / file) << content << "\n";
  }
  [[nodiscard]] std::filesystem::path root() const { return folder_.path("."); }

 private:
  detp::support::ScratchFolder folder_;
};

/// Restores the default limit after a test.
struct Restored {
  Restored() = default;
  ~Restored() { set_memory_limit({}); }
  Restored(const Restored&) = delete;
  Restored& operator=(const Restored&) = delete;
};

constexpr double unlimited = std::numeric_limits<double>::infinity();

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("for cgroups of version 2 the smallest limit counts, of the group itself and of those around it") {
    const Groups groups;
    CHECK(cgroup_limit("0::/a/b\n", groups.root().string()) == unlimited);
    groups.write("a/b/memory.max", "max");
    CHECK(cgroup_limit("0::/a/b\n", groups.root().string()) == unlimited);
    groups.write("a/memory.max", "3000000");
    CHECK(cgroup_limit("0::/a/b\n", groups.root().string()) == 3e6);
    groups.write("a/b/memory.max", "2000000");
    CHECK(cgroup_limit("0::/a/b\n", groups.root().string()) == 2e6);
    CHECK(cgroup_limit("0::/\n", groups.root().string()) == unlimited);
    groups.write("memory.max", "1000000");  // the root of a container
    CHECK(cgroup_limit("0::/\n", groups.root().string()) == 1e6);
    CHECK(cgroup_limit("0::/unseen/from/here\n", groups.root().string()) == 1e6);
  }

  TEST_CASE("for cgroups of version 1 the memory controller's limit counts") {
    const Groups groups;
    groups.write("memory/job/memory.limit_in_bytes", "5000000");
    groups.write("cpu/job/memory.limit_in_bytes", "1");
    CHECK(cgroup_limit("4:cpu,cpuacct:/job\n3:memory:/job\n", groups.root().string()) == 5e6);
    CHECK(cgroup_limit("4:cpu,cpuacct:/job\n", groups.root().string()) == unlimited);
    CHECK(cgroup_limit("no such line\n7\n:::\n", groups.root().string()) == unlimited);
  }

  TEST_CASE("sizes are bytes, or have the unit K, M, G or T") {
    CHECK(parse_bytes("1") == 1);
    CHECK(parse_bytes("1e9") == 1e9);
    CHECK(parse_bytes("2K") == 2048);
    CHECK(parse_bytes("1.5M") == 1.5 * 1024 * 1024);
    CHECK(parse_bytes("3G") == 3.0 * (1 << 30));
    CHECK(parse_bytes("1T") == 0x1p40);
  }

  TEST_CASE("a limit that was set replaces the default, half of the memory") {
    const Restored restored;
    CHECK(memory_budget() > 0);
    CHECK(memory_budget() <= machine_memory());
    set_memory_limit(1e6);
    CHECK(memory_budget() == 1e6);
    CHECK_NOTHROW(require_memory("a list", 1e6));
    CHECK_THROWS_WITH_AS(require_memory("a list", 3e6),
                         "a list would take 0.003 GB, more than the memory limit (0.001 GB)", std::length_error);
    set_memory_limit({});
    CHECK_THROWS_WITH_AS(require_memory("a list", 1e18), Contains("half of the memory"), std::length_error);
  }

  TEST_CASE("work that runs out of memory says what it was doing") {
    const auto exhausted = [] { throw std::bad_alloc(); };
    CHECK_THROWS_WITH_AS(in_memory("reading the scene", exhausted), "out of memory while reading the scene",
                         OutOfMemory);
    CHECK_THROWS_WITH_AS(in_memory("outer work", [&] { in_memory("inner work", exhausted); }),
                         "out of memory while inner work", std::bad_alloc);
    CHECK(in_memory("counting", [] { return 3; }) == 3);
    CHECK_THROWS_WITH_AS(in_memory(std::string(1000, 'x'), exhausted), Contains("while xxx"), OutOfMemory);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("text that is not a size is refused") {
    for (const char* bad : {"", "G", "0", "-1", "4X", "4GB", "1 G", "nan", "inf", "1e400", "1e300T", "0x10", "4G\n"})
      CHECK_THROWS_WITH_AS((void)parse_bytes(bad), Contains("must be a size such as 4G"), std::invalid_argument);
    for (const double bad : {0.0, -1.0, unlimited, std::numeric_limits<double>::quiet_NaN()})
      CHECK_THROWS_WITH_AS(set_memory_limit(bad), Contains("memory limit must be > 0"), std::invalid_argument);
  }
}

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
