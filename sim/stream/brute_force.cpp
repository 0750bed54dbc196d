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

void search_all(const Problem& problem, const RunOptions& options, Outcome& outcome) {
  constexpr std::size_t chunk =
      512;  // discs that stay in the first-level cache while vector after vector of rays passes
  need_memory("the discs in floats and blocks of rays", all_bytes(size_of(problem, options)), problem, outcome);
  const Frame frame(problem);
  std::vector<std::uint32_t> order(problem.discs.size());
  std::iota(order.begin(), order.end(), 0U);
  on_threads(thread_count(options.threads), [&] {
    const DiscTree discs = discs_in_order(problem, frame, std::move(order));
    tbb::enumerable_thread_specific<Worker> workers;
    Gathering gathering(problem, discs, options);
    for_each_block(problem, frame, options.stop, [&](const Block& rays) {
      const BlockSearch block = gathering.begin(frame, rays.first(), rays.traits());
      tbb::parallel_for(std::size_t{0}, (discs.discs.size() - 1) / chunk + 1, [&](std::size_t i) {
        if (options.stop.stop_requested()) return;
        const std::size_t count = std::min(chunk, discs.discs.size() - i * chunk);
        for (int k = 0; k < classes; ++k)
          test_discs(block, k, static_cast<std::uint32_t>(i * chunk), static_cast<std::uint32_t>(count),
                     rays.lists()[static_cast<std::size_t>(k)], workers.local());
        workers.local().counts.disc_tests += count * rays.size();
      });
    });
    gathering.give(workers, outcome);
  });
}

}  // namespace detp::sim::stream
