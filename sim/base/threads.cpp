#include "threads.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <exception>
#include <latch>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "floating_point.hpp"

namespace detp::sim {
namespace {

/// The number of threads that can be started beside this one, at most `most`.
int count_startable_threads(int most) {
  std::latch end(1);
  std::vector<std::thread> threads;
  threads.reserve(static_cast<std::size_t>(most));
  try {
    while (static_cast<int>(threads.size()) < most) threads.emplace_back([&end] { end.wait(); });
  } catch (const std::exception&) {  // a limit on processes or memory is reached
  }
  end.count_down();
  for (std::thread& thread : threads) thread.join();
  return static_cast<int>(threads.size());
}

}  // namespace

int startable_threads(int threads) {
  static std::mutex mutex;
  static int tried = 1;
  static int started = 1;
  const std::lock_guard lock(mutex);
  if (threads > tried) {
    // Tries one more than needed: the program may need a thread for something else.
    started = std::max(1, count_startable_threads(threads));
    tried = threads;
  }
  return std::min(threads, started);
}

int thread_count(int requested) { return requested > 0 ? requested : oneapi::tbb::this_task_arena::max_concurrency(); }

int useful_threads(int requested) { return std::min(thread_count(requested), thread_count(0)); }

void on_threads(int threads, FunctionRef<void()> work) {
  using oneapi::tbb::global_control;
  const int started = startable_threads(threads);
  const auto parallelism = static_cast<std::size_t>(started);
  std::optional<global_control> more_than_cores;
  if (parallelism > global_control::active_value(global_control::max_allowed_parallelism))
    more_than_cores.emplace(global_control::max_allowed_parallelism, parallelism);
  const auto in_default_mode = [&] {
    const DefaultFloatingPoint mode;
    work();
  };
  if (oneapi::tbb::this_task_arena::max_concurrency() == started)
    oneapi::tbb::this_task_arena::isolate(in_default_mode);
  else
    oneapi::tbb::task_arena(started).execute(in_default_mode);
}

}  // namespace detp::sim
