#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <numeric>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "disc_results.hpp"
#include "list_search.hpp"
#include "ray_blocks.hpp"
#include "search.hpp"

namespace detp::sim::stream {
namespace {

constexpr std::size_t chunk = discs_in_chunk;

/// Number of rays tested against a chunk between two checks for a stop request.
constexpr std::size_t rays_at_once = StopCheck::most_work * tests_a_unit / chunk;

/// For photon sums: tests disc after disc. Returns false if a stop request ended the tests.
bool test_one_by_one(const BlockSearch& block, const RayLists& lists, const DiscRun& discs, Worker& worker) {
  for (std::uint32_t place = discs.first; place < discs.first + discs.count; ++place) {
    if (worker.check.requested_after(test_work(size(lists)))) {
      worker.skipped.push_back({place, discs.first + discs.count - place});
      return false;
    }
    test_all_classes(block, place, 1, lists, worker);
  }
  return true;
}

/// Returns false if a stop request ended the tests.
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

class FloatBruteForce final : public Index {
 public:
  FloatBruteForce(const Problem& problem, const RunOptions& options) : frame_(problem) {
    Stopwatch watch;
    built_.bytes = checked_bytes(what, all_bytes(size_of(problem, options)), problem);
    UnsetVector<std::uint32_t> order(problem.discs().size());
    std::iota(order.begin(), order.end(), 0U);
    discs_ = discs_in_order(problem, frame_, std::move(order), options);
    built_.seconds.build = watch.lap();
  }

  void search(const Problem& problem, const RunOptions& options, Outcome& outcome) const override {
    add_checked_bytes(what, all_bytes(size_of(problem, options)), problem, outcome);
    on_threads(thread_count(options.threads), [&] {
      tbb::enumerable_thread_specific<Worker> workers([&] { return Worker(options.memory, options.stop); });
      DiscResults results(problem, discs_, options, outcome);
      for_each_block(problem, frame_, options, [&](const Block& rays) {
        test_block(results.begin(frame_, rays), rays, workers);
        results.end(rays, workers);
      });
      results.store_results(workers);
    });
  }

 private:
  static constexpr const char* what = "the discs in floats and blocks of rays";

  template <class Workers>
  void test_block(const BlockSearch& block, const Block& rays, Workers& workers) const {
    sim::parallel_for(std::size_t{0}, (discs_.discs.size() - 1) / chunk + 1, [&](std::size_t i) {
      const std::size_t count = std::min(chunk, discs_.discs.size() - i * chunk);
      Worker& worker = workers.local();
      const DiscRun run{static_cast<std::uint32_t>(i * chunk), static_cast<std::uint32_t>(count)};
      if (needs_all_classes(block)) {
        const bool done = test_one_by_one(block, rays.lists(), run, worker);
        if (done) worker.counts.disc_tests += count * (rays.size() - size(rays.lists()));
        return;
      }
      if (!test_chunk(block, rays.lists(), run, worker)) return;
      worker.counts.visits += count;
      worker.counts.disc_tests += count * rays.size();
    });
  }

  Frame frame_;
  DiscTree discs_;
};

}  // namespace

std::unique_ptr<Index> prepare_all(const Problem& problem, const RunOptions& options) {
  return std::make_unique<FloatBruteForce>(problem, options);
}

}  // namespace detp::sim::stream
