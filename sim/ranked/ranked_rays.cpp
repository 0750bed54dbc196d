#include "ranked_rays.hpp"

#include <algorithm>
#include <optional>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/ranks/failures.hpp"
#include "detp/sim/ranks/parts.hpp"
#include "detp/sim/search/irradiance.hpp"
#include "detp/sim/technique/streamed_search.hpp"

namespace detp::sim {
namespace {

void send_totals(Totals& totals, Ranks& ranks) {
  for (std::size_t band = totals.bands(); band-- > 0;) {
    Totals& one = totals.band(band);
    ranks.send_one(one.shape(), 0);
    one.for_each_array([&](const auto& array) { ranks.send_all(std::span(array.data(), array.size()), 0); });
  }
}

/// The last band comes first.
Totals receive_totals(Ranks& ranks, int from, std::size_t bands) {
  std::vector<Totals> received;
  while (true) {
    Totals one = Totals::of_shape(ranks.receive_one<Totals::Shape>(from));
    one.for_each_array([&](auto& array) { ranks.receive_all(std::span(array.data(), array.size()), from); });
    if (received.size() + 1 == bands) {
      one.set_further(std::move(received));
      return one;
    }
    received.insert(received.begin(), std::move(one));
  }
}

/// What was found in one range of rays.
struct FoundInRange {
  ShareOfRays range;
  Totals totals;
  PartOfOutcome part;
  std::vector<Pair> pairs;
};

/// The ranges of one rank.
class OwnRanges {
 public:
  OwnRanges(std::span<const Disc> discs, const RaySource& source, const Valid<Candidate>& candidate,
            const StreamOptions& options, const ShareOfRays& whole, PhotonBlocks blocks)
      : options_(options), blocks_(blocks), discs_(discs.size()), bands_(source.bands()) {
    options_.run.standard_error = false;
    with_errors_ = options.run.standard_error;
    options_.first = whole.first;
    options_.last = whole.last;
    if (whole.first < whole.last) search_.emplace(discs, source, candidate, options_);
  }

  void search_head(const ShareOfRays& head) {
    begin(head);
    search(found_.back(), head);
  }

  /// All but the head.
  void search_rest(const std::vector<ShareOfRays>& ranges) {
    const ShareOfRays head = found_.front().range;
    const auto longer = std::ranges::find(ranges, head.block, &ShareOfRays::block);
    if (longer != ranges.end() && longer->next_block > head.next_block)
      search(found_.front(), {head.last, longer->last, head.next_block, longer->next_block});
    end();
    for (const ShareOfRays& range : ranges) {
      if (range.block == head.block) continue;
      begin(range);
      search(found_.back(), range);
      end();
    }
    std::ranges::sort(found_, {}, [](const FoundInRange& one) { return one.range.block; });
  }

  [[nodiscard]] bool stopped() const { return search_ && search_->stopped(); }
  [[nodiscard]] std::vector<FoundInRange>& found() { return found_; }
  /// Of the head, without pairs and with what only one rank has: the size of blocks, the cache's spheres.
  [[nodiscard]] StreamedOutcome& outcome() { return outcome_; }

 private:
  void begin(const ShareOfRays& range) {
    FoundInRange& next = found_.emplace_back();
    next.range = {range.first, range.first, range.block, range.block};
    next.totals.set_bands(bands_);
    next.totals.set_photon_blocks(blocks_);
    if (with_errors_) next.totals.keep_errors();
    next.totals.resize(discs_);
    next.totals.begin_at(range.block);
  }

  void search(FoundInRange& found, const ShareOfRays& range) {
    if (range.first < range.last) search_->search(range.first, range.last, &found.totals);
    if (stopped()) return;
    found.totals.complete(range.next_block);
    found.range.last = range.last;
    found.range.next_block = range.next_block;
  }

  /// Takes what was found in the last range.
  void end() {
    if (!search_) return;
    StreamedOutcome found = search_->take();
    found_.back().part = part_of(found, 0);
    found_.back().pairs = std::move(found.outcome.pairs);
    if (found_.size() > 1) return;
    outcome_ = std::move(found);
    outcome_.outcome.pairs.clear();
  }

  StreamOptions options_;
  PhotonBlocks blocks_;
  std::size_t discs_;
  std::size_t bands_;
  bool with_errors_ = false;
  std::optional<StreamedSearch> search_;
  std::vector<FoundInRange> found_;
  StreamedOutcome outcome_;
};

/// Puts ranges together in the order of their rays, up to the first that is not complete.
class Collected {
 public:
  /// `first`: the range with the first ray, whose counts are in `ranked`.
  Collected(RankedOutcome& ranked, int ranks, FoundInRange&& first)
      : ranked_(ranked),
        times_(static_cast<std::size_t>(ranks)),
        totals_(std::move(first.totals)),
        next_(first.range.next_block) {
    ranked.found.outcome.pairs = std::move(first.pairs);
    times_.front() = first.part;
  }

  void add(int rank, const FoundInRange& found) {
    Outcome& all = ranked_.found.outcome;
    add_times(found.part, times_[static_cast<std::size_t>(rank)]);
    if (all.stopped) return;
    all.stopped = found.range.block != next_;
    if (all.stopped) return;
    next_ = found.range.next_block;
    totals_.append(found.totals);
    add_found(found.part, all);
    all.progress.done += found.part.done;
    all.pairs.insert(all.pairs.end(), found.pairs.begin(), found.pairs.end());
  }

  Totals& finish() {
    ranked_.found.outcome.seconds = {};
    for (const PartOfOutcome& one : times_) slow_down_to(one, ranked_.found);
    return totals_;
  }

 private:
  RankedOutcome& ranked_;
  std::vector<PartOfOutcome> times_;
  Totals totals_;
  std::uint64_t next_;
};

void send_range(FoundInRange& found, Ranks& ranks) {
  ranks.send_one(found.range, 0);
  ranks.send_one(found.part, 0);
  send_array(ranks, found.pairs, 0);
  send_totals(found.totals, ranks);
}

FoundInRange receive_range(Ranks& ranks, int from, std::size_t bands) {
  FoundInRange found;
  found.range = ranks.receive_one<ShareOfRays>(from);
  found.part = ranks.receive_one<PartOfOutcome>(from);
  found.pairs = receive_array<Pair>(ranks, from);
  found.totals = receive_totals(ranks, from, bands);
  return found;
}

/// The ranks of all ranges, in the order of their rays.
std::vector<int> in_order(const CutOfRays::Parts& parts) {
  std::vector<std::pair<std::uint64_t, int>> all;
  for (std::size_t rank = 0; rank < parts.size(); ++rank)
    for (const ShareOfRays& range : parts[rank]) all.emplace_back(range.block, static_cast<int>(rank));
  std::ranges::stable_sort(all);
  std::vector<int> ranks;
  for (const auto& [block, rank] : all) ranks.push_back(rank);
  return ranks;
}

struct HeadTime {
  double seconds = 0;
  std::uint64_t stopped = 0;
};

}  // namespace

RankedOutcome run_on_shared_rays(std::span<const Disc> discs, const RaySource& source,
                                 const Valid<Candidate>& candidate, const StreamOptions& options, Ranks& ranks) {
  const DefaultFloatingPoint mode;
  const PhotonBlocks blocks = PhotonBlocks::for_discs(discs.size());
  const auto rank = static_cast<std::size_t>(ranks.rank());
  const auto count = static_cast<std::size_t>(ranks.count());
  std::optional<CutOfRays> cut;
  std::optional<OwnRanges> own;
  std::vector<HeadTime> heads(count);
  std::vector<double> seconds(count);
  do_on_all(ranks, [&] {
    const Stopwatch whole;
    cut.emplace(source, blocks, ranks.count());
    StreamOptions of_rank = options;
    of_rank.count_building = ranks.rank() == 0;
    own.emplace(discs, source, candidate, of_rank, cut->parts()[rank].front(), blocks);
    const Stopwatch watch;
    own->search_head(cut->heads()[rank]);
    heads[rank] = {watch.seconds(), own->stopped() ? 1U : 0U};
    seconds[rank] = whole.seconds();
  });
  CutOfRays::Parts parts;
  for (const ShareOfRays& head : cut->heads()) parts.push_back({head});
  if (cut->has_rest()) {
    share_parts(ranks, std::span(heads));
    if (std::ranges::none_of(heads, [](const HeadTime& head) { return head.stopped != 0; })) {
      std::vector<double> times;
      for (const HeadTime& head : heads) times.push_back(head.seconds);
      cut->correct(times);
      parts = cut->parts();
    }
  }
  do_on_all(ranks, [&] {
    const Stopwatch watch;
    own->search_rest(parts[rank]);
    seconds[rank] += watch.seconds();
  });
  share_parts(ranks, std::span(seconds));
  RankedOutcome ranked{std::move(own->outcome())};
  Outcome& outcome = ranked.found.outcome;
  std::vector<FoundInRange>& found = own->found();
  if (rank != 0) {
    for (FoundInRange& one : found) send_range(one, ranks);
    return ranked;
  }
  ranked.seconds = seconds;
  Collected collected(ranked, ranks.count(), std::move(found.front()));
  std::size_t next_own = 1;
  const std::vector<int> order = in_order(parts);
  for (std::size_t i = 1; i < order.size(); ++i)
    order[i] == 0 ? collected.add(0, found[next_own++])
                  : collected.add(order[i], receive_range(ranks, order[i], source.bands()));
  Totals& totals = collected.finish();
  outcome.progress.of = source.size();
  totals.emitted(source.photons_of(outcome.progress.done), source.scale(outcome.progress.done));
  finish(totals, discs, outcome);
  if (!outcome.stopped) return ranked;
  outcome.pairs.clear();
  return ranked;
}

}  // namespace detp::sim
