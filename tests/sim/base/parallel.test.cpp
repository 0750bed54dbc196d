#include "detp/sim/base/parallel.hpp"

#include <doctest/doctest.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <atomic>
#include <cfenv>
#include <cstddef>
#include <stdexcept>
#include <thread>
#include <vector>

#include "detp/sim/base/threads.hpp"
#include "support/machine.hpp"

namespace detp::support {

/// Limits the address space of this process, and of processes that it starts, while the object exists.
class AddressLimit {
 public:
  explicit AddressLimit(double bytes) : bytes_(static_cast<std::size_t>(bytes)) {
    getrlimit(RLIMIT_AS, &before_);
    const rlimit limit{bytes_, before_.rlim_max};
    setrlimit(RLIMIT_AS, &limit);
  }
  ~AddressLimit() { setrlimit(RLIMIT_AS, &before_); }
  AddressLimit(const AddressLimit&) = delete;
  AddressLimit& operator=(const AddressLimit&) = delete;

  /// False where the system does not heed it, as under an emulator.
  [[nodiscard]] bool holds() const {
    void* const more = mmap(nullptr, bytes_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (more != MAP_FAILED) munmap(more, bytes_);
    return more == MAP_FAILED;
  }

 private:
  std::size_t bytes_;
  rlimit before_{};
};

}  // namespace detp::support

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

  TEST_CASE("a modest number of threads can all be started, and they run the work") {
    CHECK(startable_threads(1) == 1);
    CHECK(startable_threads(4) == 4);
    std::atomic<int> sum = 0;
    on_threads(4, [&] { oneapi::tbb::parallel_for(0, 1000, [&](int i) { sum += i; }); });
    CHECK(sum == 499'500);
  }

  TEST_CASE("0 threads are those of the caller's arena, and work on N threads runs on at most N") {
    oneapi::tbb::task_arena arena(3);
    arena.execute([&] {
      CHECK(thread_count(0) == 3);
      for (const int threads : {thread_count(0), 1, 2}) {
        int concurrency = 0;
        std::atomic<int> at_work = 0;
        std::atomic<int> most = 0;
        on_threads(threads, [&] {
          concurrency = oneapi::tbb::this_task_arena::max_concurrency();
          oneapi::tbb::parallel_for(0, 1000, [&](int) {
            const int now = ++at_work;
            for (int before = most; before < now && !most.compare_exchange_weak(before, now);) {
            }
            std::this_thread::yield();
            --at_work;
          });
        });
        CHECK(concurrency == threads);
        CHECK(most <= threads);
      }
    });
  }

  TEST_CASE("if the system does not start all threads, fewer do the work") {
    if (detp::support::sanitized) return;  // a sanitizer needs much address space itself
    pthread_attr_t attributes;
    std::size_t stack = 0;
    if (pthread_getattr_default_np(&attributes) == 0) pthread_attr_getstacksize(&attributes, &stack);
    if (stack < std::size_t{4} << 20) {
      MESSAGE("skipped: threads have small stacks here (ulimit -s)");
      return;
    }
    const detp::support::AddressLimit limit(8e9);  // the stacks of 4000 threads take about 32 GB
    if (!limit.holds()) {
      MESSAGE("skipped: the address space cannot be limited here");
      return;
    }
    const int started = startable_threads(4000);
    CHECK(started >= 1);
    CHECK(started < 4000);
    std::atomic<int> sum = 0;
    on_threads(4000, [&] { oneapi::tbb::parallel_for(0, 1000, [&](int i) { sum += i; }); });
    CHECK(sum == 499'500);
  }
}
