#include <algorithm>
#include <cmath>
#include <utility>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/ranks/failures.hpp"
#include "detp/sim/ranks/parts.hpp"
#include "detp/sim/search/irradiance.hpp"
#include "disc_cut.hpp"
#include "disc_parts.hpp"
#include "ranked.hpp"
#include "ranked_part.hpp"

namespace detp::sim {
namespace {

constexpr std::uint64_t rays_of_pilot = std::uint64_t{1} << 17;
constexpr double bytes_of_buffers = 24 << 20;  // for parts of discs and their results, which are in files, and the cut

/// The parts of one rank, searched one after another.
class DiscShare {
 public:
  DiscShare(const DiscSource& discs, const RaySource& source, const Valid<Candidate>& candidate,
            const StreamOptions& options, std::size_t first, std::size_t count)
      : discs_(discs),
        source_(source),
        candidate_(candidate),
        options_(options),
        first_(first),
        count_(count),
        results_(options.run.standard_error, source.bands()) {}

  /// Takes its parts of the discs.
  void take(const DiscCut& cut) {
    part_.reset();
    parts_.emplace(discs_, cut, first_, count_, options_.run.stop);
  }

  /// Seconds that the first rays take in the first part.
  [[nodiscard]] double pilot() {
    part_ = parts_->take(0);
    StreamOptions options = options_;
    options.run.pairs = options.run.standard_error = options.run.count = false;
    options.run.progress = {};
    options.progress = {};
    options.last = rays_of_pilot;
    const StreamedOutcome found = run_streamed(part_->discs, source_, candidate_, options);
    if (found.outcome.stopped) throw Stopped("stopped while the discs were shared", {0, source_.size(), "rays"});
    return found.outcome.seconds.search;
  }

  void search() {
    for (std::size_t i = 0; i < count_; ++i) {
      if (!part_) part_ = parts_->take(i);
      StreamOptions own = options_;
      own.kept_bytes += static_cast<double>(part_->discs.size() * sizeof(std::uint32_t));
      const auto all = static_cast<double>(count_);
      const auto before = static_cast<double>(i);
      if (options_.progress) own.progress = [&](double done) { options_.progress((before + done) / all); };
      if (options_.run.progress)
        own.run.progress = [&](double share) { options_.run.progress((before + share) / all); };
      search_part(own);
      part_.reset();
      return_freed_memory();  // the arrays of the next part have other sizes, and would be allocated beside the freed ones
    }
  }

  [[nodiscard]] StreamedOutcome& found() { return *found_; }
  [[nodiscard]] PartResults& results() { return results_; }

 private:
  void search_part(StreamOptions& options) {
    Totals totals;
    totals.set_bands(source_.bands());
    if (options.run.standard_error) totals.keep_errors();
    totals.resize(part_->discs.size());
    totals.set_photon_blocks(PhotonBlocks::for_discs(discs_.size()));
    options.run.totals = &totals;
    options.run.standard_error = false;
    StreamedOutcome found = run_streamed(part_->discs, source_, candidate_, options);
    Outcome& outcome = found.outcome;
    if (outcome.stopped)
      throw Stopped("stopped after " + std::to_string(outcome.progress.done) + " rays of a share of the discs",
                    outcome.progress);
    for (Pair& pair : outcome.pairs) pair.disc = part_->numbers[pair.disc];
    results_.add(*part_, totals, outcome.pairs);
    outcome.pairs = {};
    if (!found_) {
      found_ = std::move(found);
      return;
    }
    const PartOfOutcome later = part_of(found, 0);
    PartOfOutcome times = part_of(*found_, 0);
    add_times(later, times);
    add_found(later, found_->outcome);
    slow_down_to(times, *found_);
  }

  const DiscSource& discs_;
  const RaySource& source_;
  const Valid<Candidate>& candidate_;
  const StreamOptions& options_;
  std::size_t first_;
  std::size_t count_;
  std::optional<DiscParts> parts_;
  std::optional<PartOfDiscs> part_;
  PartResults results_;
  std::optional<StreamedOutcome> found_;
};

/// Moves the results of all discs to the outcome's arrays.
void fill_in(const PartResults& results, Outcome& outcome) {
  resize_results(static_cast<std::size_t>(results.discs()), results.errors(), outcome, results.bands());
  std::size_t disc = 0;
  results.for_each_disc([&](std::span<const DiscResult> by_band) {
    outcome.hits[disc] = by_band[0].hits;
    for (std::size_t band = 0; band < by_band.size(); ++band) {
      BandResults& to = outcome.band(band);
      to.irradiance[disc] = by_band[band].irradiance;
      if (!results.errors()) continue;
      to.standard_error[disc] = by_band[band].standard_error;
      to.upper_bound[disc] = by_band[band].upper_bound;
    }
    ++disc;
  });
  outcome.pairs.reserve(static_cast<std::size_t>(results.pairs()));
  results.for_each_pair([&](const Pair& pair) { outcome.pairs.push_back(pair); });
}

/// Nothing if a part did not fit in memory, and `smaller` parts can be tried.
std::optional<RankedOutcome> search_parts(const DiscSource& discs, const RaySource& source,
                                          const Valid<Candidate>& candidate, const StreamOptions& options, Ranks& ranks,
                                          std::size_t each, bool smaller) {
  const auto count = static_cast<std::size_t>(ranks.count());
  if (discs.size() < count * each) throw std::invalid_argument("there are more parts than discs to share");
  DiscShare share(discs, source, candidate, options, static_cast<std::size_t>(ranks.rank()) * each, each);
  std::optional<DiscCut> cut;
  std::vector<double> seconds(count);
  double& own_seconds = seconds[static_cast<std::size_t>(ranks.rank())];
  std::exception_ptr too_large;
  const auto do_in_memory = [&](const auto& work) {
    do_on_all(ranks, [&] {
      try {
        work();
      } catch (const std::length_error&) {
        too_large = std::current_exception();
      }
    });
    if (smaller && largest(ranks, too_large ? 1 : 0) == 1) return false;
    agree(ranks, too_large);
    return true;
  };
  const bool pilots =
      count > 1 && each == 1 && source.size() >= std::max<std::uint64_t>(16 * rays_of_pilot, 4 * discs.size());
  double order_seconds = 0;
  const bool piloted = do_in_memory([&] {
    const Stopwatch watch;
    cut.emplace(discs, count * each, options.run.stop);
    share.take(*cut);
    order_seconds = watch.seconds();
    if (pilots) own_seconds = share.pilot();
  });
  if (!piloted) return std::nullopt;
  share_parts(ranks, std::span(seconds));
  const bool unequal = pilots && imbalance(seconds) > most_imbalance;
  const bool searched = do_in_memory([&] {
    if (unequal) {
      cut->correct(seconds);
      share.take(*cut);
    }
    cut.reset();
    const Stopwatch watch;
    share.search();
    own_seconds = watch.seconds();
  });
  if (!searched) return std::nullopt;
  PartResults& results = share.results();
  std::vector<double> heaviest;
  for (const double power : results.largest_powers()) heaviest.push_back(largest(ranks, power));
  RankedOutcome ranked{std::move(share.found())};
  ranked.found.outcome.seconds.order += order_seconds;
  if (ranks.rank() != 0) {
    ranks.send_one(part_of(ranked.found, own_seconds), 0);
    results.send(ranks, 0);
    return ranked;
  }
  if (count > 1) ranked.seconds.push_back(own_seconds);
  for (int from = 1; from < ranks.count(); ++from) {
    const auto part = ranks.receive_one<PartOfOutcome>(from);
    add_found(part, ranked.found.outcome);
    slow_down_to(part, ranked.found);
    ranked.seconds.push_back(part.seconds);
    results.receive(ranks, from);
  }
  results.finish(heaviest, source.photons(), source.scale(source.size()));
  if (discs.in_memory().empty())
    ranked.results = std::make_shared<const PartResults>(std::move(results));
  else
    fill_in(results, ranked.found.outcome);
  return ranked;
}

/// The number of parts of each rank to begin with: their index and sums take about 60 % of the memory.
std::size_t first_parts(const DiscSource& discs, Ranks& ranks) {
  const double bytes = bytes_of_disc * static_cast<double>(discs.size()) / ranks.count();
  const double memory = std::max(memory_budget() - bytes_of_buffers, memory_budget() / 4);
  const double most = static_cast<double>(discs.size()) / ranks.count();
  return largest(ranks, static_cast<std::size_t>(std::max(1.0, std::min(most, std::ceil(bytes / (0.6 * memory))))));
}

}  // namespace

RankedOutcome run_on_shared_discs(const DiscSource& discs, const RaySource& source, const Valid<Candidate>& candidate,
                                  const StreamOptions& options, Ranks& ranks, std::optional<std::size_t> each) {
  const DefaultFloatingPoint mode;
  constexpr std::size_t fewest_discs = 1024;  // in a part, so that the work ends if nothing fits
  StreamOptions own = options;
  own.kept_bytes += bytes_of_buffers;
  if (!discs.in_memory().empty()) {
    const double results = (2 + (options.run.standard_error ? 2 : 0)) * sizeof(double);
    own.kept_bytes += static_cast<double>(discs.size()) * (sizeof(Disc) + results);
    do_on_all(ranks, [&] {
      require_memory(std::to_string(discs.size()) + " discs and their results, part by part,", own.kept_bytes);
    });
  }
  if (each) return *search_parts(discs, source, candidate, own, ranks, *each, false);
  const auto count = static_cast<std::size_t>(ranks.count());
  for (std::size_t parts = first_parts(discs, ranks);; parts *= 2) {
    const bool smaller = discs.size() >= 2 * parts * count * fewest_discs;
    if (auto found = search_parts(discs, source, candidate, own, ranks, parts, smaller)) return std::move(*found);
  }
}

}  // namespace detp::sim
