#pragma once

#include "function_ref.hpp"

namespace detp::sim {

inline constexpr int most_threads = 4096;

/// The number of threads that an option means: 0 means all threads of the oneTBB arena in which the caller runs; outside
/// of an arena, all cores that this process may use.
[[nodiscard]] int thread_count(int requested);

/// The same, but at most as many as there are cores: more threads are no faster.
[[nodiscard]] int useful_threads(int requested);

/// The number of threads, this one included, that can run in this process: at least 1, at most `threads`. Call it
/// before oneTBB starts threads: oneTBB ends the process if a limit on processes or memory prevents a start. A call
/// whose `threads` is larger than in all earlier calls finds the number by starting threads; other calls start none.
[[nodiscard]] int startable_threads(int threads);

/// Calls `work`, in the default floating-point mode. Its oneTBB algorithms run on `threads` threads, including this one, or on fewer if the program has
/// limited oneTBB to fewer or if no more can be started. If the caller runs in an arena of as many threads, they run in
/// that arena, isolated from its other tasks; otherwise in an arena of their own.
void on_threads(int threads, FunctionRef<void()> work);

}  // namespace detp::sim
