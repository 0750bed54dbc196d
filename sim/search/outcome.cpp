#include "outcome.hpp"

#include <utility>

namespace detp::sim {

void clear(Outcome& outcome) {
  Outcome empty;
  const auto keep = [&](auto Outcome::*array) {
    (outcome.*array).clear();
    empty.*array = std::move(outcome.*array);
  };
  keep(&Outcome::hits);
  keep(&Outcome::irradiance);
  keep(&Outcome::standard_error);
  keep(&Outcome::spheres);
  keep(&Outcome::pairs);
  outcome = std::move(empty);
}

void finish(const Totals& totals, std::span<const Disc> discs, Outcome& outcome) {
  outcome.hits.resize(discs.size());
  outcome.irradiance.resize(discs.size());
  for (std::size_t disc = 0; disc < discs.size(); ++disc) {
    outcome.hits[disc] = totals[disc].hits;
    outcome.irradiance[disc] = irradiance(totals[disc], discs[disc]);
  }
}

void keep_done_discs(Outcome& outcome) {
  outcome.progress = {0, outcome.done_discs.size(), "discs"};
  outcome.total_hits = 0;
  for (std::size_t disc = 0; disc < outcome.done_discs.size(); ++disc) {
    if (!outcome.done_discs[disc]) outcome.hits[disc] = 0;
    if (!outcome.done_discs[disc]) outcome.irradiance[disc] = 0;
    outcome.progress.done += outcome.done_discs[disc] ? 1 : 0;
    outcome.total_hits += outcome.hits[disc];
  }
  outcome.counts.hits = outcome.total_hits;
}

}  // namespace detp::sim
