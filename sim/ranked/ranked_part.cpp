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

void add_found(const PartOfOutcome& part, Outcome& all) {
  Outcome one;
  one.counts = part.counts;
  one.vectors = part.vectors;
  one.batches = part.batches;
  one.total_hits = part.total_hits;
  one.stopped = part.stopped != 0;
  add_block(one, all);
}

void slow_down_to(const PartOfOutcome& part, StreamedOutcome& all) {
  Phases& phases = all.outcome.seconds;
  phases = {std::max(phases.prepare, part.phases.prepare), std::max(phases.order, part.phases.order),
            std::max(phases.build, part.phases.build), std::max(phases.search, part.phases.search)};
  all.read_seconds = std::max(all.read_seconds, part.read_seconds);
  all.check_seconds = std::max(all.check_seconds, part.check_seconds);
  all.bytes = std::max(all.bytes, part.bytes);
}

void add_times(const PartOfOutcome& later, PartOfOutcome& all) {
  all.phases = {all.phases.prepare + later.phases.prepare, all.phases.order + later.phases.order,
                all.phases.build + later.phases.build, all.phases.search + later.phases.search};
  all.read_seconds += later.read_seconds;
  all.check_seconds += later.check_seconds;
  all.bytes = std::max(all.bytes, later.bytes);
}

}  // namespace detp::sim
