#include "detp/sim/base/threads.hpp"

#include <doctest/doctest.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <atomic>
#include <mutex>
#include <set>
#include <thread>

#include "support/address_limit.hpp"
#include "support/sanitized.hpp"

using namespace detp::sim;

TEST_SUITE("known answer") {
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
        std::mutex mutex;
        std::set<std::thread::id> seen;
        on_threads(threads, [&] {
          concurrency = oneapi::tbb::this_task_arena::max_concurrency();
          oneapi::tbb::parallel_for(0, 1000, [&](int) {
            const std::lock_guard lock(mutex);
            seen.insert(std::this_thread::get_id());
          });
        });
        CHECK(concurrency == threads);
        CHECK(static_cast<int>(seen.size()) <= threads);
      }
    });
  }

  TEST_CASE("if the system does not start all threads, fewer do the work") {
    if (detp::support::sanitized) return;          // a sanitizer needs much address space itself
    const detp::support::AddressLimit limit(8e9);  // the stacks of 4000 threads take about 32 GB
    const int started = startable_threads(4000);
    CHECK(started >= 1);
    CHECK(started < 4000);
    std::atomic<int> sum = 0;
    on_threads(4000, [&] { oneapi::tbb::parallel_for(0, 1000, [&](int i) { sum += i; }); });
    CHECK(sum == 499'500);
  }
}
