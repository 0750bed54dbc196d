#include "streamed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/search/irradiance.hpp"
#include "streamed_search.hpp"
#include "successive_search.hpp"
#include "technique.hpp"

namespace detp::sim {

StreamedSearch::StreamedSearch(std::span<const Disc> discs, const RaySource& source, const Valid<Candidate>& candidate,
                               const StreamOptions& options)
    : source_(source),
      options_(options),
      run_(options.run),
      expected_(options.last.value_or(source.size()) - options.first),
      problem_(problem_of(discs)) {
  const std::size_t block = options.block > 0 ? options.block : block_in_memory(discs.size());
  streamed_.block = static_cast<std::size_t>(std::min<std::uint64_t>(block, expected_));
  predict_bytes();
  try {
    index_ = prepare(problem_, candidate, run_);
    const Built& built = index_->built();
    streamed_.outcome.seconds = built.seconds;
    if (run_.count && options.count_building) streamed_.outcome.counts = built.counts;
    streamed_.bytes = own_bytes_ + built.bytes;
  } catch (const Stopped&) {
    streamed_.outcome = unsearched_outcome(problem_, run_);
    streamed_.outcome.progress.of = expected_;
    stopped_ = true;
  }
  run_.memory = &scratch_;
  if (options.run.progress)
    run_.progress = [this](double share) {
      options_.run.progress(std::min(1.0, (static_cast<double>(searched_) + share * searching_) / expected()));
    };
}

Problem StreamedSearch::problem_of(std::span<const Disc> discs) {
  const std::uint64_t last = options_.last.value_or(source_.size());
  if (options_.first >= last || last > source_.size()) throw std::invalid_argument("there must be at least one ray");
  Stopwatch watch;
  Problem problem = make_problem_without_rays(discs, source_.farthest_from(enclosing_sphere(discs, run_.stop).centre),
                                              options_.front_facing, run_.stop);
  streamed_.check_seconds = watch.lap();
  return problem;
}

/// Predicts the bytes needed besides those of each block's search. Throws before allocation if they do not fit.
void StreamedSearch::predict_bytes() {
  const double for_a_disc = sizeof(Disc) + sizeof(DiscTotals) + sizeof(std::uint64_t) + sizeof(double) +
                            (options_.run.standard_error ? error_bytes : 0);
  const auto ray_bytes = static_cast<double>(bytes_of_ray_in(source_.bands()));
  own_bytes_ = options_.kept_bytes + source_.kept_bytes(streamed_.block) +
               static_cast<double>(problem_.discs().size()) * for_a_disc +
               static_cast<double>(streamed_.block) * (ray_bytes + (source_.numbered() ? sizeof(std::uint64_t) : 0));
  streamed_.bytes = own_bytes_;
  require_memory(fmt::format("{} discs and blocks of {} rays", problem_.discs().size(), streamed_.block), own_bytes_);
  problem_.set_kept_bytes(own_bytes_ - static_cast<double>(problem_.discs().size()) * sizeof(Disc) -
                          static_cast<double>(streamed_.block) * ray_bytes);
}

void StreamedSearch::search(std::uint64_t first, std::uint64_t last, Totals* totals) {
  if (stopped_) return;
  constexpr std::size_t first_piece = std::size_t{1}
                                      << 14;  // so that a run that is stopped early has searched some rays
  Outcome& outcome = streamed_.outcome;
  const auto end = [&] { return std::min(last, source_.size()); };
  const std::uint64_t of = outcome.progress.of + (end() - first);
  const double bytes = streamed_.bytes;
  run_.totals = totals;
  searching_ = static_cast<double>(end() - first);
  SuccessiveSearch search(*index_, problem_, run_, first, end(), own_bytes_, outcome);
  outcome.progress.of = of;
  std::size_t piece = index_->sorts_rays() ? streamed_.block : std::min(first_piece, streamed_.block);
  std::vector<Ray> block;
  block.reserve(std::min<std::uint64_t>(streamed_.block,
                                        end() - first));  // in one piece: smaller ones would stay with the allocator
  BesideRays beside;
  try {
    while (search.next() < end() && !search.stopped()) {
      const std::uint64_t next = search.next();
      if (options_.progress)
        options_.progress(std::min(1.0, static_cast<double>(searched_ + next - first) / expected()));
      StopCheck(run_.stop, "reading rays").now();
      Stopwatch watch;
      on_threads(thread_count(run_.threads), [&] {
        const std::uint64_t to = source_.block_end(next, piece, run_.stop);
        block.resize(static_cast<std::size_t>(std::min(last, to) - next));
        source_.read_all(next, block, beside, run_.stop);
      });
      streamed_.read_seconds += watch.lap();
      scratch_.begin();
      PathRays rays(block, beside.photons, {});
      rays.further = {beside.further, source_.bands() - 1};
      search.add(rays);
      if (run_.stop.stop_possible()) search.add_batch();
      piece = std::min(2 * piece, streamed_.block);
    }
  } catch (const Stopped&) {  // while making rays
    search.stop();
  }
  const std::uint64_t done = first == 0 ? search.done() : source_.size();
  search.finish(source_.photons_of(done), source_.scale(std::max<std::uint64_t>(1, done)));
  searched_ += search.next() - first;
  stopped_ = outcome.stopped;
  streamed_.check_seconds += std::exchange(outcome.seconds.prepare, 0);
  streamed_.bytes = std::max(bytes, outcome.bytes);
}

StreamedOutcome StreamedSearch::take() {
  StreamedOutcome next;
  next.block = streamed_.block;
  next.bytes = streamed_.bytes;
  next.outcome.stopped = stopped_;
  return std::exchange(streamed_, std::move(next));
}

std::size_t default_block(std::size_t discs) { return std::max(std::size_t{1} << 20, rays_in_block(discs)); }

std::size_t block_in_memory(std::size_t discs) {
  constexpr std::size_t least = std::size_t{1} << 15;
  constexpr std::size_t for_few_discs = std::size_t{1} << 18;
  constexpr double rays_in_most = 1e12;
  const double rays = std::min(memory_budget() / (8 * sizeof(Ray)), rays_in_most);
  const std::size_t block = std::max(for_few_discs, rays_in_block(discs));
  return std::min(block, std::max(least, std::bit_floor(static_cast<std::size_t>(rays))));
}

StreamedOutcome run_streamed(std::span<const Disc> discs, const RaySource& source, const Valid<Candidate>& candidate,
                             const StreamOptions& options) {
  const DefaultFloatingPoint mode;
  StreamedSearch search(discs, source, candidate, options);
  search.search(options.first, options.last.value_or(UINT64_MAX), options.run.totals);
  return search.take();
}

}  // namespace detp::sim
