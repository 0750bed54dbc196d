#include "streamed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/scratch.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/search/index.hpp"
#include "detp/sim/search/irradiance.hpp"
#include "registry.hpp"

namespace detp::sim {
namespace {

class StreamedSearch {
 public:
  StreamedSearch(std::span<const Disc> discs, const RaySource& source, const Valid<Candidate>& candidate,
                 const StreamOptions& options)
      : source_(source), candidate_(candidate), options_(options), run_(options.run), problem_(problem_of(discs)) {
    const std::size_t block = options.block > 0 ? options.block : default_block(discs.size());
    streamed_.block = static_cast<std::size_t>(std::min<std::uint64_t>(block, source.size()));
    predict_bytes();
    try {
      index_ = prepare(problem_, candidate_, run_);
      const Built& built = index_->built();
      streamed_.outcome.seconds = built.seconds;
      if (run_.count) streamed_.outcome.counts = built.counts;
      streamed_.bytes = std::max(streamed_.bytes, own_bytes_ + built.bytes);
    } catch (const Stopped&) {
      streamed_.outcome.stopped = true;
    }
    if (run_.standard_error) totals_.keep_errors();
    totals_.resize(discs.size());
    run_.totals = &totals_;
    run_.memory = &scratch_;
    run_.standard_error = false;  // of a block
  }

  StreamedOutcome run_all() && {
    Outcome& outcome = streamed_.outcome;
    outcome.progress.of = source_.size();
    try {
      for (std::uint64_t first = 0; first < source_.size() && !outcome.stopped; first += block_.size()) {
        if (options_.progress) options_.progress(static_cast<double>(first) / static_cast<double>(source_.size()));
        outcome.stopped = run_.stop.stop_requested();
        if (!outcome.stopped) search(first);
      }
    } catch (const Stopped&) {  // stopped while making rays
      outcome.stopped = true;
    }
    if (outcome.stopped) outcome.pairs.clear();
    totals_.emitted(source_.photons());
    finish(totals_, problem_.discs(), outcome);
    if (outcome.stopped) outcome.standard_error.clear();
    if (outcome.stopped) outcome.upper_bound.clear();
    return std::move(streamed_);
  }

 private:
  Problem problem_of(std::span<const Disc> discs) {
    require_few_enough();
    Stopwatch watch;
    Problem problem = make_problem_without_rays(discs, source_.farthest_from(enclosing_sphere(discs, run_.stop).centre),
                                                options_.front_facing, run_.stop);
    streamed_.check_seconds = watch.lap();
    return problem;
  }

  void require_few_enough() const {
    if (run_.totals != nullptr) throw std::invalid_argument("a stream has its own totals; options must have none");
    if (source_.size() == 0) throw std::invalid_argument("there must be at least one ray");
    if (run_.pairs && source_.size() >= UINT32_MAX)
      throw std::length_error(
          fmt::format("{} rays are too many for pairs; the maximum is {}", source_.size(), UINT32_MAX - 1));
  }

  /// Predicts the bytes needed besides those of each block's search. Throws before allocation if they do not fit.
  void predict_bytes() {
    const double for_a_disc = sizeof(Disc) + sizeof(DiscTotals) + sizeof(std::uint64_t) + sizeof(double) +
                              (options_.run.standard_error ? error_bytes : 0);
    own_bytes_ =
        static_cast<double>(problem_.discs().size()) * for_a_disc +
        static_cast<double>(streamed_.block) * (sizeof(Ray) + (source_.numbered() ? sizeof(std::uint64_t) : 0));
    streamed_.bytes = std::max(streamed_.bytes, own_bytes_);
    require_memory(fmt::format("{} discs and blocks of {} rays", problem_.discs().size(), streamed_.block), own_bytes_);
  }

  void search(std::uint64_t first) {
    Stopwatch watch;
    const std::size_t count = static_cast<std::size_t>(source_.block_end(first, streamed_.block) - first);
    block_.resize(count);
    on_threads(thread_count(run_.threads), [&] { source_.read_numbered(first, block_, photons_, run_.stop); });
    streamed_.read_seconds += watch.lap();
    set_rays(problem_, {block_, photons_, {}}, options_.run.threads, first);
    streamed_.check_seconds += watch.lap();
    scratch_.begin();
    sim::search(*index_, problem_, run_, part_);
    const std::size_t pairs = streamed_.outcome.pairs.size() + part_.pairs.size();
    const double bytes = own_bytes_ + part_.bytes + grown_bytes(pairs, sizeof(Pair));
    if (pairs > 0) require_memory("the pairs", bytes);
    streamed_.bytes = std::max(streamed_.bytes, bytes);
    add(part_, static_cast<std::uint32_t>(first), count);
  }

  void add(const Outcome& part, std::uint32_t first, std::size_t rays) {
    Outcome& sum = streamed_.outcome;
    add_block(part, sum);
    sum.progress.done += part.stopped ? part.progress.done : rays;
    sum.pairs.reserve(std::max(sum.pairs.capacity(), std::bit_ceil(sum.pairs.size() + part.pairs.size())));
    for (const Pair& pair : part.pairs) sum.pairs.push_back({pair.ray + first, pair.disc});
  }

  const RaySource& source_;
  const Valid<Candidate>& candidate_;
  const StreamOptions& options_;
  RunOptions run_;
  StreamedOutcome streamed_;
  Problem problem_;
  std::unique_ptr<Index> index_;
  Totals totals_;
  std::vector<Ray> block_;
  std::vector<std::uint64_t> photons_;  ///< their numbers; empty if rays have none
  Scratch scratch_;
  Outcome part_;  ///< of one block
  double own_bytes_ = 0;
};

}  // namespace

std::size_t default_block(std::size_t discs) {
  constexpr std::size_t least = std::size_t{1} << 20;
  constexpr std::size_t most = std::size_t{1} << 22;
  return std::bit_ceil(std::clamp(discs, least, most));
}

StreamedOutcome run_streamed(std::span<const Disc> discs, const RaySource& source, const Valid<Candidate>& candidate,
                             const StreamOptions& options) {
  const DefaultFloatingPoint mode;
  return StreamedSearch(discs, source, candidate, options).run_all();
}

}  // namespace detp::sim
