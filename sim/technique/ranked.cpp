#include "ranked.hpp"

#include <algorithm>
#include <numeric>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/ranks/failures.hpp"
#include "detp/sim/search/irradiance.hpp"
#include "ranked_part.hpp"

namespace detp::sim {
namespace {

void send_totals(Totals& totals, Ranks& ranks) {
  ranks.send_one(totals.shape(), 0);
  totals.for_each_array([&](const auto& array) { ranks.send_all(std::span(array.data(), array.size()), 0); });
}

Totals receive_totals(Ranks& ranks, int from) {
  Totals totals = Totals::of_shape(ranks.receive_one<Totals::Shape>(from));
  totals.for_each_array([&](auto& array) { ranks.receive_all(std::span(array.data(), array.size()), from); });
  return totals;
}

/// Adds the part of another rank, unless one before it was stopped.
void add_part_of(Ranks& ranks, int from, Totals& totals, RankedOutcome& ranked) {
  const auto part = ranks.receive_one<PartOfOutcome>(from);
  const std::vector<Pair> pairs = receive_array<Pair>(ranks, from);
  const Totals more = receive_totals(ranks, from);
  ranked.seconds.push_back(part.seconds);
  Outcome& all = ranked.found.outcome;
  if (all.stopped) return;
  totals.append(more);
  add(part, ranked);
  all.progress.done += part.done;
  all.pairs.insert(all.pairs.end(), pairs.begin(), pairs.end());
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
                           const StreamOptions& options, Ranks& ranks, Share divided) {
  if (ranks.count() == 1) return {run_in_memory(discs, source, candidate, options)};
  if (divided == Share::discs) return run_on_shared_discs(discs, source, candidate, options, ranks);
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
    ranks.send_one(part_of(found, own_seconds), 0);
    send_array(ranks, found.outcome.pairs, 0);
    send_totals(totals, ranks);
    return ranked;
  }
  ranked.seconds.push_back(own_seconds);
  for (int from = 1; from < ranks.count(); ++from) add_part_of(ranks, from, totals, ranked);
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

Share usual_share(std::size_t discs, int ranks) {
  constexpr double bytes = 400;  // of a disc with its results, a box tree, and totals of 2¹² blocks
  const bool fits = bytes * static_cast<double>(discs) <= memory_budget();
  return fits || discs < static_cast<std::size_t>(ranks) ? Share::rays : Share::discs;
}

}  // namespace detp::sim
