#include "threads.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/task_arena.h>

#include <optional>

namespace detp::sim {

int thread_count(int asked) { return asked > 0 ? asked : oneapi::tbb::info::default_concurrency(); }

void on_threads(int threads, const std::function<void()>& work) {
  using oneapi::tbb::global_control;
  const auto wanted = static_cast<std::size_t>(threads);
  std::optional<global_control> more_than_cores;
  if (wanted > global_control::active_value(global_control::max_allowed_parallelism))
    more_than_cores.emplace(global_control::max_allowed_parallelism, wanted);
  oneapi::tbb::task_arena(threads).execute(work);
}

}  // namespace detp::sim
