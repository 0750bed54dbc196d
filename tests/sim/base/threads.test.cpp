#include "detp/sim/base/threads.hpp"

#include <doctest/doctest.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <pthread.h>

#include <atomic>
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
