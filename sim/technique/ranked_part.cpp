#include "ranked_part.hpp"

#include <algorithm>

namespace detp::sim {

PartOfOutcome part_of(const StreamedOutcome& found, double seconds) {
  const Outcome& outcome = found.outcome;
  return {.counts = outcome.counts,
          .vectors = outcome.vectors,
          .batches = outcome.batches,
          .phases = outcome.seconds,
          .total_hits = outcome.total_hits,
          .done = outcome.progress.done,
          .read_seconds = found.read_seconds,
          .check_seconds = found.check_seconds,
          .bytes = found.bytes,
          .seconds = seconds,
          .stopped = outcome.stopped ? 1 : 0};
}

void add(const PartOfOutcome& part, RankedOutcome& ranked) {
  StreamedOutcome& all = ranked.found;
  Outcome one;
  one.counts = part.counts;
  one.vectors = part.vectors;
  one.batches = part.batches;
  one.total_hits = part.total_hits;
  one.stopped = part.stopped != 0;
  add_block(one, all.outcome);
  Phases& phases = all.outcome.seconds;
  phases = {std::max(phases.prepare, part.phases.prepare), std::max(phases.order, part.phases.order),
            std::max(phases.build, part.phases.build), std::max(phases.search, part.phases.search)};
  all.read_seconds = std::max(all.read_seconds, part.read_seconds);
  all.check_seconds = std::max(all.check_seconds, part.check_seconds);
  all.bytes = std::max(all.bytes, part.bytes);
}

}  // namespace detp::sim
