#pragma once

#include "function_ref.hpp"

namespace detp::sim {

inline constexpr int most_threads = 4096;

/// The number of threads that an option means: 0 means all cores that this process may use.
[[nodiscard]] int thread_count(int requested);

/// How many of `threads` threads the system lets this process start, at least 1. A limit on processes or memory may
/// prevent a start, and oneTBB then ends the process. To find out, starts threads: once for each number larger than all
/// before.
[[nodiscard]] int startable_threads(int threads);

/// Calls `work`, whose oneTBB algorithms then run on `threads` threads, including this one. They run on fewer if the
/// program has limited oneTBB to fewer, or if no more can be started.
void on_threads(int threads, FunctionRef<void()> work);

}  // namespace detp::sim
