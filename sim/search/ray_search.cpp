#include "ray_search.hpp"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <functional>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/threads.hpp"
#include "hit_collector.hpp"

namespace detp::sim {
namespace {

constexpr std::size_t chunks_a_thread = 4;

struct Chunk {
  std::uint32_t first = 0;
  std::uint32_t last = 0;
  FoundPairs* hits = nullptr;
};

/// Cuts the rays into chunks of whole photons. Chunks in flight use the buffers for their hits in turn.
class Chunks {
 public:
  Chunks(const Problem& problem, std::size_t under_way, const RunOptions& options)
      : problem_(problem),
        rays_(problem.rays().size()),
        buffers_(under_way, options.memory),
        stop_(options.stop),
        progress_(options.progress) {}

  /// Returns false after the last chunk, or after a stop request.
  bool next(Chunk& chunk) {
    if (begun_ >= rays_ || stop_.stop_requested()) return false;
    if (progress_) progress_(static_cast<double>(begun_) / static_cast<double>(rays_));
    std::size_t end = std::min(begun_ + rays_in_chunk, rays_);
    while (problem_.numbered() && end < rays_ && problem_.photon(end) == problem_.photon(end - 1)) ++end;
    chunk = {static_cast<std::uint32_t>(begun_), static_cast<std::uint32_t>(end), &buffers_[made_++ % buffers_.size()]};
    chunk.hits->clear();
    begun_ = end;
    return true;
  }

 private:
  const Problem& problem_;
  std::size_t rays_;
  std::size_t begun_ = 0;
  std::size_t made_ = 0;
  std::pmr::vector<FoundPairs> buffers_;
  const std::stop_token& stop_;
  const std::function<void(double)>& progress_;
};

/// Adds up the hits, chunk by chunk.
class HitSum {
 public:
  explicit HitSum(HitCollector& collector) : collector_(collector) {}

  void add(const Chunk& chunk) {
    for (const Pair& hit : *chunk.hits) collector_.add_hit(hit.ray, hit.disc);
    batches_.add(chunk.last - chunk.first, static_cast<double>(chunk.hits->size()));
  }

  [[nodiscard]] const Batches& batches() const { return batches_; }

 private:
  HitCollector& collector_;
  Batches batches_;
};

Counts<std::uint64_t> search_alone(Chunks& chunks, MakeRaySearch make, HitSum& sum) {
  const OwnedIn<RaySearch> search = make();
  try {
    for (Chunk chunk; chunks.next(chunk);) {
      search->search(chunk.first, chunk.last, *chunk.hits);
      sum.add(chunk);
    }
  } catch (const Stopped&) {  // the unfinished chunk is left out
  }
  return search->counts();
}

/// Chunks leave the pipeline in order, so a buffer is free when its turn comes again.
Counts<std::uint64_t> search_together(Chunks& chunks, std::size_t under_way, MakeRaySearch make, HitSum& total) {
  oneapi::tbb::enumerable_thread_specific<OwnedIn<RaySearch>> searches([&] { return make(); });
  try {
    sim::parallel_pipeline<Chunk>(
        under_way, [&](Chunk& chunk) { return chunks.next(chunk); },
        [&](const Chunk& chunk) { searches.local()->search(chunk.first, chunk.last, *chunk.hits); },
        [&](const Chunk& chunk) { total.add(chunk); });
  } catch (const Stopped&) {  // unfinished chunks are left out
  }
  Counts<std::uint64_t> counts;
  for (const OwnedIn<RaySearch>& one : searches) counts += one->counts();
  return counts;
}

}  // namespace

void search_rays(const Problem& problem, const RunOptions& options, MakeRaySearch make, Outcome& outcome) {
  const int threads = thread_count(options.threads);
  const std::size_t under_way = threads == 1 ? 1 : chunks_a_thread * static_cast<std::size_t>(threads);
  HitCollector collector(problem, options, outcome);
  Chunks chunks(problem, under_way, options);
  HitSum sum(collector);
  if (threads == 1)
    outcome.counts = search_alone(chunks, make, sum);
  else
    on_threads(threads, [&] { outcome.counts = search_together(chunks, under_way, make, sum); });
  outcome.batches = sum.batches();
  collector.store_results(outcome.batches.rays);
}

}  // namespace detp::sim
