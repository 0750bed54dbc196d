#include "streamed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/scratch.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/search/index.hpp"
#include "detp/sim/search/irradiance.hpp"
#include "registry.hpp"
#include "successive_search.hpp"

namespace detp::sim {
namespace {

class StreamedSearch {
 public:
  StreamedSearch(std::span<const Disc> discs, const RaySource& source, const Valid<Candidate>& candidate,
                 const StreamOptions& options)
      : source_(source),
        options_(options),
        run_(options.run),
        last_(options.last.value_or(source.size())),
        problem_(problem_of(discs)) {
    const std::size_t block =
        options.block > 0 ? options.block : std::min(default_block(discs.size()), block_in_memory());
    streamed_.block = static_cast<std::size_t>(std::min<std::uint64_t>(block, last_ - options.first));
    predict_bytes();
    try {
      index_ = prepare(problem_, candidate, run_);
      const Built& built = index_->built();
      streamed_.outcome.seconds = built.seconds;
      if (run_.count && options.count_building) streamed_.outcome.counts = built.counts;
      streamed_.bytes = own_bytes_ + built.bytes;
    } catch (const Stopped&) {
      streamed_.outcome = unsearched_outcome(problem_, run_);
      streamed_.outcome.progress.of = last_ - options.first;
    }
    run_.memory = &scratch_;
  }

  StreamedOutcome run_all() && {
    if (index_) search_all();
    return std::move(streamed_);
  }

 private:
  /// As many rays as take an eighth of the memory budget, but at least 2¹⁵.
  static std::size_t block_in_memory() {
    constexpr std::size_t least = std::size_t{1} << 15;
    constexpr double rays_in_most = 1e12;
    const double rays = std::min(memory_budget() / (8 * sizeof(Ray)), rays_in_most);
    return std::max(least, std::bit_floor(static_cast<std::size_t>(rays)));
  }

  Problem problem_of(std::span<const Disc> discs) {
    if (options_.first >= last_ || last_ > source_.size())
      throw std::invalid_argument("there must be at least one ray");
    Stopwatch watch;
    Problem problem = make_problem_without_rays(discs, source_.farthest_from(enclosing_sphere(discs, run_.stop).centre),
                                                options_.front_facing, run_.stop);
    streamed_.check_seconds = watch.lap();
    return problem;
  }

  /// Predicts the bytes needed besides those of each block's search. Throws before allocation if they do not fit.
  void predict_bytes() {
    const double for_a_disc = sizeof(Disc) + sizeof(DiscTotals) + sizeof(std::uint64_t) + sizeof(double) +
                              (options_.run.standard_error ? error_bytes : 0);
    own_bytes_ =
        options_.kept_bytes + source_.kept_bytes() + static_cast<double>(problem_.discs().size()) * for_a_disc +
        static_cast<double>(streamed_.block) * (sizeof(Ray) + (source_.numbered() ? sizeof(std::uint64_t) : 0));
    streamed_.bytes = own_bytes_;
    require_memory(fmt::format("{} discs and blocks of {} rays", problem_.discs().size(), streamed_.block), own_bytes_);
    problem_.set_kept_bytes(own_bytes_ - static_cast<double>(problem_.discs().size()) * sizeof(Disc) -
                            static_cast<double>(streamed_.block) * sizeof(Ray));
  }

  void search_all() {
    Outcome& outcome = streamed_.outcome;
    const auto all = static_cast<double>(last_ - options_.first);
    SuccessiveSearch search(*index_, problem_, run_, options_.first, last_, own_bytes_, outcome);
    std::vector<Ray> block;
    std::vector<std::uint64_t> photons;  // their numbers; empty if rays have none
    try {
      while (search.next() < last_ && !search.stopped()) {
        const std::uint64_t first = search.next();
        if (options_.progress) options_.progress(static_cast<double>(first - options_.first) / all);
        StopCheck(run_.stop, "reading rays").now();
        Stopwatch watch;
        block.resize(static_cast<std::size_t>(std::min(last_, source_.block_end(first, streamed_.block)) - first));
        on_threads(thread_count(run_.threads), [&] { source_.read_numbered(first, block, photons, run_.stop); });
        streamed_.read_seconds += watch.lap();
        scratch_.begin();
        search.add({block, photons, {}});
      }
    } catch (const Stopped&) {  // while making rays
      search.stop();
    }
    search.finish(source_.photons());
    streamed_.check_seconds += std::exchange(outcome.seconds.prepare, 0);
    streamed_.bytes = std::max(streamed_.bytes, outcome.bytes);
  }

  const RaySource& source_;
  const StreamOptions& options_;
  RunOptions run_;
  std::uint64_t last_;
  StreamedOutcome streamed_;
  Problem problem_;
  std::unique_ptr<Index> index_;
  Scratch scratch_;
  double own_bytes_ = 0;
};

}  // namespace

std::size_t default_block(std::size_t discs) {
  constexpr std::size_t least = std::size_t{1} << 20;
  constexpr std::size_t most = std::size_t{1} << 24;
  return std::bit_ceil(std::clamp(4 * std::min(discs, most), least, most));
}

StreamedOutcome run_streamed(std::span<const Disc> discs, const RaySource& source, const Valid<Candidate>& candidate,
                             const StreamOptions& options) {
  const DefaultFloatingPoint mode;
  return StreamedSearch(discs, source, candidate, options).run_all();
}

}  // namespace detp::sim
