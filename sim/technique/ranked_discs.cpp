#include <algorithm>
#include <numeric>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/geometry/curve_sort.hpp"
#include "detp/sim/ranks/failures.hpp"
#include "detp/sim/ranks/parts.hpp"
#include "detp/sim/search/irradiance.hpp"
#include "ranked.hpp"
#include "ranked_part.hpp"

namespace detp::sim {
namespace {

constexpr std::uint64_t rays_of_pilot = std::uint64_t{1} << 17;

/// The discs in the order of the Morton curve, cut into parts of equal cost.
class CurveCut {
 public:
  CurveCut(std::span<const Disc> discs, int ranks, const std::stop_token& stop)
      : cuts_(static_cast<std::size_t>(ranks) + 1) {
    Box centres;
    double squares = 0;
    for (const Disc& disc : discs) {
      centres.include(disc.centre);
      squares += disc.radius * disc.radius;
    }
    const double mean = squares / static_cast<double>(discs.size());
    const stream::CurvePlaces places = stream::sort_along_curve(discs, centres, 1, stop);
    order_.reserve(discs.size());
    costs_.reserve(discs.size());
    for (const stream::CurvePlace place : places) {
      const std::uint32_t number = stream::place_index(place);
      order_.push_back(number);
      costs_.push_back(
          static_cast<float>(1 + discs[number].radius * discs[number].radius / mean));  // to reach it, and hits
    }
    cut();
  }

  /// The numbers of the rank's discs, rising.
  [[nodiscard]] std::vector<std::uint32_t> part(int rank) const {
    const auto number = static_cast<std::size_t>(rank);
    std::vector<std::uint32_t> numbers(order_.begin() + cuts_[number], order_.begin() + cuts_[number + 1]);
    std::ranges::sort(numbers);
    return numbers;
  }

  /// Cuts anew: the parts so far took so many seconds.
  void correct(std::span<const double> seconds) {
    for (std::size_t rank = 0; rank < seconds.size(); ++rank) {
      double cost = 0;
      for (std::ptrdiff_t i = cuts_[rank]; i < cuts_[rank + 1]; ++i) cost += costs_[static_cast<std::size_t>(i)];
      for (std::ptrdiff_t i = cuts_[rank]; i < cuts_[rank + 1]; ++i)
        costs_[static_cast<std::size_t>(i)] *= static_cast<float>(seconds[rank] / cost);
    }
    cut();
  }

 private:
  /// Each part has at least one disc.
  void cut() {
    const double all = std::accumulate(costs_.begin(), costs_.end(), 0.0);
    const auto parts = static_cast<std::ptrdiff_t>(cuts_.size()) - 1;
    const auto discs = static_cast<std::ptrdiff_t>(costs_.size());
    double before = 0;
    std::ptrdiff_t next = 0;
    for (std::ptrdiff_t part = 1; part < parts; ++part) {
      const double wanted = all * static_cast<double>(part) / static_cast<double>(parts);
      const std::ptrdiff_t least = cuts_[static_cast<std::size_t>(part - 1)] + 1;
      while (next < discs - (parts - part) && (next < least || before < wanted))
        before += costs_[static_cast<std::size_t>(next++)];
      cuts_[static_cast<std::size_t>(part)] = next;
    }
    cuts_.back() = discs;
  }

  std::vector<std::uint32_t> order_;
  std::vector<float> costs_;  ///< in this order
  std::vector<std::ptrdiff_t> cuts_;
};

/// One rank's discs, and what it finds.
class DiscShare {
 public:
  DiscShare(std::span<const Disc> all, std::vector<std::uint32_t> numbers, const StreamOptions& options)
      : numbers_(std::move(numbers)), options_(options), photon_blocks_(PhotonBlocks::for_discs(all.size())) {
    for (const std::uint32_t number : numbers_) discs_.push_back(all[number]);
  }

  /// Seconds that the first rays take.
  [[nodiscard]] double pilot(const RaySource& source, const Valid<Candidate>& candidate) const {
    StreamOptions options = options_;
    options.run.pairs = options.run.standard_error = options.run.count = false;
    options.run.progress = {};
    options.progress = {};
    options.last = rays_of_pilot;
    const StreamedOutcome found = run_streamed(discs_, source, candidate, options);
    if (found.outcome.stopped) throw Stopped("stopped while the discs were shared", {0, source.size(), "rays"});
    return found.outcome.seconds.search;
  }

  void search(const RaySource& source, const Valid<Candidate>& candidate) {
    if (options_.run.standard_error) totals_.keep_errors();
    totals_.resize(discs_.size());
    totals_.set_photon_blocks(photon_blocks_);
    StreamOptions own = options_;
    own.run.totals = &totals_;
    own.run.standard_error = false;
    found_ = run_streamed(discs_, source, candidate, own);
    if (found_.outcome.stopped)
      throw Stopped("stopped after " + std::to_string(found_.outcome.progress.done) + " rays of a share of the discs",
                    found_.outcome.progress);
    for (Pair& pair : found_.outcome.pairs) pair.disc = numbers_[pair.disc];
    totals_.emitted(source.photons());
  }

  /// Of all photons that met these discs.
  [[nodiscard]] double largest_power() const {
    double largest = totals_.largest_power();
    for (const PhotonSums& sums : totals_.photon_sums()) largest = std::max(largest, sums.largest);
    return largest;
  }

  /// `largest_power`: of all shares.
  void finish(double largest_power) {
    totals_.set_largest_power(largest_power);
    sim::finish(totals_, discs_, found_.outcome);
  }

  [[nodiscard]] const std::vector<std::uint32_t>& numbers() const { return numbers_; }
  [[nodiscard]] StreamedOutcome& found() { return found_; }

 private:
  std::vector<std::uint32_t> numbers_;
  const StreamOptions& options_;
  PhotonBlocks photon_blocks_;
  std::vector<Disc> discs_;
  Totals totals_;
  StreamedOutcome found_;
};

/// Puts the values of the discs with these numbers in their places. Empty arrays stay empty.
template <class T>
void place(const std::vector<T>& values, const std::vector<std::uint32_t>& numbers, std::size_t discs,
           std::vector<T>& all) {
  if (values.empty()) return;
  all.resize(discs);
  for (std::size_t i = 0; i < numbers.size(); ++i) all[numbers[i]] = values[i];
}

struct DiscArrays {
  std::vector<std::uint32_t> numbers;
  std::vector<std::uint64_t> hits;
  std::vector<double> irradiance;
  std::vector<double> standard_error;
  std::vector<double> upper_bound;
};

void place_all(const DiscArrays& from, std::size_t discs, Outcome& all) {
  place(from.hits, from.numbers, discs, all.hits);
  place(from.irradiance, from.numbers, discs, all.irradiance);
  place(from.standard_error, from.numbers, discs, all.standard_error);
  place(from.upper_bound, from.numbers, discs, all.upper_bound);
}

}  // namespace

RankedOutcome run_on_shared_discs(std::span<const Disc> discs, const RaySource& source,
                                  const Valid<Candidate>& candidate, const StreamOptions& options, Ranks& ranks) {
  if (discs.size() < static_cast<std::size_t>(ranks.count()))
    throw std::invalid_argument("there are more ranks than discs to share");
  const std::stop_token& stop = options.run.stop;
  std::optional<CurveCut> cut;
  std::optional<DiscShare> share;
  std::vector<double> seconds(static_cast<std::size_t>(ranks.count()));
  double& own_seconds = seconds[static_cast<std::size_t>(ranks.rank())];
  const bool pilots = source.size() >= std::max<std::uint64_t>(16 * rays_of_pilot, 4 * discs.size());
  do_on_all(ranks, [&] {
    cut.emplace(discs, ranks.count(), stop);
    share.emplace(discs, cut->part(ranks.rank()), options);
    if (pilots) own_seconds = share->pilot(source, candidate);
  });
  share_parts(ranks, std::span(seconds));
  if (pilots && imbalance(seconds) > most_imbalance) {
    cut->correct(seconds);
    share.emplace(discs, cut->part(ranks.rank()), options);
  }
  cut.reset();
  std::vector<double> largest(seconds.size());
  do_on_all(ranks, [&] {
    const Stopwatch watch;
    share->search(source, candidate);
    largest[static_cast<std::size_t>(ranks.rank())] = share->largest_power();
    own_seconds = watch.seconds();
  });
  share_parts(ranks, std::span(largest));
  share->finish(*std::ranges::max_element(largest));
  RankedOutcome ranked;
  Outcome& own = share->found().outcome;
  if (ranks.rank() != 0) {
    ranks.send_one(part_of(share->found(), own_seconds), 0);
    send_array(ranks, share->numbers(), 0);
    send_array(ranks, own.hits, 0);
    send_array(ranks, own.irradiance, 0);
    send_array(ranks, own.standard_error, 0);
    send_array(ranks, own.upper_bound, 0);
    send_array(ranks, own.pairs, 0);
    ranked.found = std::move(share->found());
    return ranked;
  }
  StreamedOutcome& all = ranked.found;
  all = std::move(share->found());
  Outcome& outcome = all.outcome;
  const DiscArrays first{share->numbers(), std::move(outcome.hits), std::move(outcome.irradiance),
                         std::move(outcome.standard_error), std::move(outcome.upper_bound)};
  for (auto* array : {&outcome.irradiance, &outcome.standard_error, &outcome.upper_bound}) array->clear();
  outcome.hits.clear();
  place_all(first, discs.size(), outcome);
  ranked.seconds.push_back(own_seconds);
  for (int from = 1; from < ranks.count(); ++from) {
    const auto part = ranks.receive_one<PartOfOutcome>(from);
    add_found(part, ranked.found.outcome);
    slow_down_to(part, ranked.found);
    ranked.seconds.push_back(part.seconds);
    DiscArrays arrays;
    arrays.numbers = receive_array<std::uint32_t>(ranks, from);
    arrays.hits = receive_array<std::uint64_t>(ranks, from);
    arrays.irradiance = receive_array<double>(ranks, from);
    arrays.standard_error = receive_array<double>(ranks, from);
    arrays.upper_bound = receive_array<double>(ranks, from);
    place_all(arrays, discs.size(), outcome);
    const std::vector<Pair> pairs = receive_array<Pair>(ranks, from);
    outcome.pairs.insert(outcome.pairs.end(), pairs.begin(), pairs.end());
  }
  std::ranges::sort(outcome.pairs);
  return ranked;
}

StreamedOutcome run_in_parts(std::span<const Disc> discs, const RaySource& source, const Valid<Candidate>& candidate,
                             const StreamOptions& options, int parts) {
  if (options.run.standard_error)
    throw std::invalid_argument("discs that do not fit in memory are searched in parts, without standard errors");
  const CurveCut cut(discs, parts, options.run.stop);
  RankedOutcome ranked;
  Outcome& all = ranked.found.outcome;
  for (int part = 0; part < parts; ++part) {
    StreamOptions own = options;
    // The discs, their place on the curve and its cost, and the results.
    own.kept_bytes +=
        static_cast<double>(discs.size() * (sizeof(Disc) + 2 * sizeof(std::uint32_t) + 2 * sizeof(double)));
    if (options.progress) own.progress = [&](double done) { options.progress((part + done) / parts); };
    if (options.run.progress) own.run.progress = [&](double share) { options.run.progress((part + share) / parts); };
    DiscShare share(discs, cut.part(part), own);
    share.search(source, candidate);
    share.finish(share.largest_power());
    StreamedOutcome& found = share.found();
    PartOfOutcome counted = part_of(found, 0);
    counted.phases = {counted.phases.prepare + all.seconds.prepare, counted.phases.order + all.seconds.order,
                      counted.phases.build + all.seconds.build,
                      counted.phases.search + all.seconds.search};  // one after another
    counted.read_seconds += ranked.found.read_seconds;
    counted.check_seconds += ranked.found.check_seconds;
    add_found(counted, ranked.found.outcome);
    slow_down_to(counted, ranked.found);
    const Outcome& outcome = found.outcome;
    place_all({share.numbers(), outcome.hits, outcome.irradiance, {}, {}}, discs.size(), all);
    all.pairs.insert(all.pairs.end(), outcome.pairs.begin(), outcome.pairs.end());
    all.progress = outcome.progress;
    ranked.found.block = found.block;
  }
  std::ranges::sort(all.pairs);
  return std::move(ranked.found);
}

StreamedOutcome run_in_memory(std::span<const Disc> discs, const RaySource& source, const Valid<Candidate>& candidate,
                              const StreamOptions& options) {
  constexpr std::size_t most_parts = 64;
  try {
    return run_streamed(discs, source, candidate, options);
  } catch (const std::length_error&) {
    if (options.run.pairs || options.run.standard_error) throw;
  }
  for (std::size_t parts = 2;; parts *= 2) try {
      return run_in_parts(discs, source, candidate, options, static_cast<int>(parts));
    } catch (const std::length_error&) {
      if (2 * parts > std::min(most_parts, discs.size())) throw;
    }
}

}  // namespace detp::sim
