#include "detp/sim/base/parallel.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <cfenv>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "detp/sim/base/threads.hpp"
#include "support/flushing.hpp"

using namespace detp;
using namespace detp::sim;
using support::flushes;
using support::Flushing;

namespace {

constexpr std::size_t task_count = 1000;

/// How many of the tasks of each algorithm flush subnormal numbers to zero.
int flushing_tasks() {
  std::atomic<int> flushing = 0;
  const auto look = [&] { flushing += flushes() ? 1 : 0; };
  sim::parallel_for(std::size_t{0}, task_count, [&](std::size_t) { look(); });
  sim::parallel_for(ParallelRange(0, task_count, 1), [&](const ParallelRange&) { look(); });
  sim::parallel_invoke(look, look);
  std::size_t next = 0;
  sim::parallel_pipeline<std::size_t>(
      4,
      [&](std::size_t& item) {
        look();
        item = next++;
        return item < task_count;
      },
      [&](std::size_t) { look(); }, [&](std::size_t) { look(); });
  const int sum = sim::parallel_reduce(
      ParallelRange(0, task_count, 1), 0,
      [&](const ParallelRange& part, int before) {
        look();
        return before + static_cast<int>(part.size());
      },
      [&](int a, int b) {
        look();
        return a + b;
      });
  CHECK(sum == task_count);
  return flushing;
}

/// Calls `work` on a thread in which oneTBB first ran while subnormal numbers were flushed, as Embree does.
template <class Work>
void after_flushing_start(const Work& work) {
  std::thread([&] {
    {
      const Flushing mode;
      oneapi::tbb::parallel_for(0, 100, [](int) {});
    }
    work();
  }).join();
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("tasks keep subnormal numbers, even if oneTBB was started by code that flushes them") {
    after_flushing_start([] {
      CHECK_FALSE(flushes());
      CHECK(flushing_tasks() == 0);
    });
  }

  TEST_CASE("tasks keep subnormal numbers if their caller flushes them, and the caller's mode stays") {
    after_flushing_start([] {
      const Flushing mode;
      CHECK(flushes());
      CHECK(flushing_tasks() == 0);
      for (const int threads : {1, 3}) on_threads(threads, [] { CHECK_FALSE(flushes()); });
      CHECK(flushes());
    });
  }

  TEST_CASE("the caller's rounding stays outside of the default mode's scope, and after an exception") {
    std::fesetround(FE_UPWARD);
    {
      const DefaultFloatingPoint mode;
      CHECK(std::fegetround() == FE_TONEAREST);
    }
    CHECK(std::fegetround() == FE_UPWARD);
    const auto fail = [](int) { throw std::runtime_error("failed"); };
    CHECK_THROWS_AS(sim::parallel_for(0, 10, fail), std::runtime_error);
    CHECK(std::fegetround() == FE_UPWARD);
    std::fesetround(FE_TONEAREST);
  }

  TEST_CASE("the pipeline adds all items, in the order in which they were cut") {
    std::vector<std::size_t> added;
    std::size_t next = 0;
    sim::parallel_pipeline<std::size_t>(
        5, [&](std::size_t& item) { return (item = next++) < task_count; }, [](std::size_t) {},
        [&](std::size_t item) { added.push_back(item); });
    REQUIRE(added.size() == task_count);
    for (std::size_t i = 0; i < task_count; ++i) CHECK(added[i] == i);
  }
}
