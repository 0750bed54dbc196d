#pragma once

#include <algorithm>
#include <atomic>
#include <mutex>
#include <numeric>
#include <vector>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/search/outcome.hpp"

/// Work on each disc, for the estimators that look at one disc after another.
namespace detp::sim {

/// Reports the share of the discs that are done, from any thread.
class DiscProgress {
 public:
  DiscProgress(const RunOptions& options, std::size_t discs) : options_(options), discs_(discs) {}

  void done() {
    const std::size_t before = done_++;
    if (!options_.progress || before % 64 != 0) return;
    const std::lock_guard lock(one_at_a_time_);
    options_.progress(static_cast<double>(done_ - 1) / static_cast<double>(discs_));
  }

 private:
  const RunOptions& options_;
  std::size_t discs_;
  std::atomic<std::size_t> done_ = 0;
  std::mutex one_at_a_time_;
};

/// Calls work(disc) for each disc on options.threads threads, at_once discs after one another, with a `work` = make() for each such
/// part. Returns whether each disc was done: not if a stop request came before its end, or if `work` returned false.
template <class Make>
std::vector<char> for_each_disc(const RunOptions& options, std::size_t discs, std::size_t at_once, const Make& make) {
  std::vector<char> done(discs);
  DiscProgress progress(options, discs);
  on_threads(thread_count(options.threads), [&] {
    sim::parallel_for(std::size_t{0}, (discs + at_once - 1) / at_once, [&](std::size_t part) {
      auto work = make();
      for (std::size_t i = part * at_once; i < std::min(discs, (part + 1) * at_once); ++i) {
        if (options.stop.stop_requested()) return;
        progress.done();
        done[i] = work(i) ? 1 : 0;
      }
    });
  });
  return done;
}

/// Sums up the discs' hits; if not all discs were done, the outcome is stopped, and those are left out.
inline void add_up_discs(const std::vector<char>& done, Outcome& outcome) {
  outcome.total_hits = std::accumulate(outcome.hits.begin(), outcome.hits.end(), std::uint64_t{0});
  outcome.counts.hits = outcome.total_hits;
  outcome.stopped = std::ranges::find(done, 0) != done.end();
  if (!outcome.stopped) return;
  outcome.done_discs.assign(done.begin(), done.end());
  keep_done_discs(outcome);
}

}  // namespace detp::sim
