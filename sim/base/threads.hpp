#pragma once

#include <functional>

namespace detp::sim {

inline constexpr int most_threads = 4096;

/// How many threads are meant: 0 is all cores that this process may use.
[[nodiscard]] int thread_count(int asked);

/// As many of these threads as the system lets this process start, at least 1. (oneTBB ends the process where it cannot
/// start one: a limit of processes or of memory may forbid that.) Starts threads to find out, once for each number
/// larger than those before.
[[nodiscard]] int startable_threads(int threads);

/// Calls `work`, whose oneTBB algorithms then run on that many threads, this one among them. On fewer, where the
/// program has limited oneTBB to fewer, or no more can be started.
void on_threads(int threads, const std::function<void()>& work);

}  // namespace detp::sim
