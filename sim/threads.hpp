#pragma once

#include <functional>

namespace detp::sim {

/// How many threads are meant: 0 is all cores that this process may use.
[[nodiscard]] int thread_count(int asked);

/// Calls `work`, whose oneTBB algorithms then run on that many threads, this one among them. On fewer, where the
/// program has limited oneTBB to fewer.
void on_threads(int threads, const std::function<void()>& work);

}  // namespace detp::sim
