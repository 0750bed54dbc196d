#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

#include "detp/sim/technique/techniques.hpp"
#include "detp/sim/threads.hpp"
#include "gathering.hpp"
#include "list_search.hpp"
#include "ray_blocks.hpp"
#include "search.hpp"

namespace detp::sim::stream {
namespace {

/// Discs that stay in the first-level cache while vector after vector of rays passes.
constexpr std::size_t chunk = 512;

/// Rays tested against a chunk between two checks for a stop request.
constexpr std::size_t rays_at_once = StopCheck::most_work * tests_a_unit / chunk;

/// Whether it was finished: not after a stop request.
bool test_chunk(const BlockSearch& block, const RayLists& lists, const DiscRun& discs, Worker& worker) {
  for (int k = 0; k < classes; ++k) {
    const RayList& rays = lists[static_cast<std::size_t>(k)];
    for (std::size_t first = 0; first < rays.size; first += rays_at_once) {
      const RayList some = part_of(rays, first, std::min(rays_at_once, rays.size - first));
      if (worker.check.requested_after(test_work(some.size, discs.count))) {
        worker.skipped.push_back(discs);
        return false;
      }
      test_discs(block, k, discs.first, discs.count, some, worker);
    }
  }
  return true;
}

}  // namespace

void search_all(const Problem& problem, const RunOptions& options, Outcome& outcome) {
  need_memory("the discs in floats and blocks of rays", all_bytes(size_of(problem, options)), problem, outcome);
  const Frame frame(problem);
  std::vector<std::uint32_t> order(problem.discs.size());
  std::iota(order.begin(), order.end(), 0U);
  on_threads(thread_count(options.threads), [&] {
    const DiscTree discs = discs_in_order(problem, frame, std::move(order), options.stop);
    tbb::enumerable_thread_specific<Worker> workers([&] { return Worker(options.stop); });
    Gathering gathering(problem, discs, options, outcome);
    for_each_block(problem, frame, options.stop, [&](const Block& rays) {
      const BlockSearch block = gathering.begin(frame, rays.first(), rays.traits());
      tbb::parallel_for(std::size_t{0}, (discs.discs.size() - 1) / chunk + 1, [&](std::size_t i) {
        const std::size_t count = std::min(chunk, discs.discs.size() - i * chunk);
        Worker& worker = workers.local();
        const DiscRun run{static_cast<std::uint32_t>(i * chunk), static_cast<std::uint32_t>(count)};
        if (test_chunk(block, rays.lists(), run, worker)) worker.counts.disc_tests += count * rays.size();
      });
      gathering.end(rays, workers);
    });
    gathering.give(workers);
  });
}

}  // namespace detp::sim::stream
