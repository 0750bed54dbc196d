#include "ranked.hpp"

#include <algorithm>
#include <numeric>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/ranks/failures.hpp"
#include "detp/sim/search/irradiance.hpp"

namespace detp::sim {
namespace {

/// What a rank sends besides its totals; trivially copyable.
struct PartOfOutcome {
  Counts<std::uint64_t> counts;
  Vectors vectors;
  HitBatches batches;
  Phases phases;
  std::uint64_t total_hits = 0;
  std::uint64_t done = 0;
  std::uint64_t pairs = 0;
  double read_seconds = 0;
  double check_seconds = 0;
  double bytes = 0;
  double seconds = 0;
  int stopped = 0;
};

void send_totals(Totals& totals, Ranks& ranks) {
  ranks.send_one(totals.shape(), 0);
  totals.for_each_array([&](const auto& array) { ranks.send_all(std::span(array.data(), array.size()), 0); });
}

Totals receive_totals(Ranks& ranks, int from) {
  Totals totals = Totals::of_shape(ranks.receive_one<Totals::Shape>(from));
  totals.for_each_array([&](auto& array) { ranks.receive_all(std::span(array.data(), array.size()), from); });
  return totals;
}

void send_part(const StreamedOutcome& found, double seconds, Ranks& ranks) {
  const Outcome& outcome = found.outcome;
  ranks.send_one(PartOfOutcome{.counts = outcome.counts,
                               .vectors = outcome.vectors,
                               .batches = outcome.batches,
                               .phases = outcome.seconds,
                               .total_hits = outcome.total_hits,
                               .done = outcome.progress.done,
                               .pairs = outcome.pairs.size(),
                               .read_seconds = found.read_seconds,
                               .check_seconds = found.check_seconds,
                               .bytes = found.bytes,
                               .seconds = seconds,
                               .stopped = outcome.stopped ? 1 : 0},
                 0);
  ranks.send_all(std::span<const Pair>(outcome.pairs), 0);
}

Phases slower(const Phases& a, const Phases& b) {
  return {std::max(a.prepare, b.prepare), std::max(a.order, b.order), std::max(a.build, b.build),
          std::max(a.search, b.search)};
}

/// Adds the part of another rank, unless one before it was stopped.
void add_part(Ranks& ranks, int from, Totals& totals, RankedOutcome& ranked) {
  const auto part = ranks.receive_one<PartOfOutcome>(from);
  std::vector<Pair> pairs(part.pairs);
  ranks.receive_all(std::span(pairs), from);
  const Totals more = receive_totals(ranks, from);
  ranked.seconds.push_back(part.seconds);
  StreamedOutcome& all = ranked.found;
  if (all.outcome.stopped) return;
  totals.append(more);
  Outcome one;
  one.counts = part.counts;
  one.vectors = part.vectors;
  one.batches = part.batches;
  one.total_hits = part.total_hits;
  one.stopped = part.stopped != 0;
  add_block(one, all.outcome);
  all.outcome.seconds = slower(all.outcome.seconds, part.phases);
  all.outcome.progress.done += part.done;
  all.outcome.pairs.insert(all.outcome.pairs.end(), pairs.begin(), pairs.end());
  all.read_seconds = std::max(all.read_seconds, part.read_seconds);
  all.check_seconds = std::max(all.check_seconds, part.check_seconds);
  all.bytes = std::max(all.bytes, part.bytes);
}

}  // namespace

std::vector<ShareOfRays> shares_of_rays(const RaySource& source, PhotonBlocks photon_blocks, int ranks) {
  const std::uint64_t blocks = photon_blocks.of(source.photons() - 1) + 1;
  std::vector<std::uint64_t> starts;  // first ray of each block; at the end, the number of all rays
  for (std::uint64_t block = 0; block < blocks; ++block)
    starts.push_back(source.first_ray_of(photon_blocks.first(block)));
  starts.push_back(source.size());
  const auto fits = [&](std::uint64_t most) {  // with at most so many rays a rank
    int needed = 1;
    std::uint64_t first = 0;
    for (std::uint64_t block = 0; block < blocks; ++block) {
      if (starts[block + 1] - starts[block] > most) return false;
      if (starts[block + 1] - starts[first] <= most) continue;
      first = block;
      ++needed;
    }
    return needed <= ranks;
  };
  std::uint64_t low = source.size() / static_cast<std::uint64_t>(ranks);
  std::uint64_t high = source.size();
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    fits(middle) ? high = middle : low = middle + 1;
  }
  std::vector<ShareOfRays> shares;
  for (std::uint64_t block = 0; static_cast<int>(shares.size()) < ranks;) {
    const std::uint64_t first = block;
    while (block < blocks && starts[block + 1] - starts[first] <= high) ++block;
    shares.push_back({starts[first], starts[block], first, block});
  }
  return shares;
}

double imbalance(std::span<const double> seconds) {
  if (seconds.empty()) return 0;
  const double sum = std::accumulate(seconds.begin(), seconds.end(), 0.0);
  return *std::ranges::max_element(seconds) / (sum / static_cast<double>(seconds.size())) - 1;
}

RankedOutcome run_on_ranks(std::span<const Disc> discs, const RaySource& source, const Valid<Candidate>& candidate,
                           const StreamOptions& options, Ranks& ranks) {
  if (ranks.count() == 1) return {run_streamed(discs, source, candidate, options)};
  const Stopwatch watch;
  double own_seconds = 0;
  Totals totals;
  totals.set_photon_blocks(PhotonBlocks::for_discs(discs.size()));
  const auto rank = static_cast<std::size_t>(ranks.rank());
  const ShareOfRays share = shares_of_rays(source, totals.photon_blocks(), ranks.count())[rank];
  RankedOutcome ranked;
  StreamedOutcome& found = ranked.found;
  do_on_all(ranks, [&] {
    if (options.run.standard_error) totals.keep_errors();
    totals.resize(discs.size());
    totals.begin_at(share.block);
    if (share.first == share.last) return totals.complete(share.next_block);
    StreamOptions own = options;
    own.run.totals = &totals;
    own.run.standard_error = false;
    own.first = share.first;
    own.last = share.last;
    own.count_building = ranks.rank() == 0;
    found = run_streamed(discs, source, candidate, own);
    if (!found.outcome.stopped) totals.complete(share.next_block);
    own_seconds = watch.seconds();
  });
  if (ranks.rank() != 0) {
    send_part(found, own_seconds, ranks);
    send_totals(totals, ranks);
    return ranked;
  }
  ranked.seconds.push_back(own_seconds);
  for (int from = 1; from < ranks.count(); ++from) add_part(ranks, from, totals, ranked);
  Outcome& outcome = found.outcome;
  outcome.progress.of = source.size();
  totals.emitted(source.photons());
  finish(totals, discs, outcome);
  if (!outcome.stopped) return ranked;
  outcome.pairs.clear();
  outcome.standard_error.clear();
  outcome.upper_bound.clear();
  return ranked;
}

}  // namespace detp::sim
