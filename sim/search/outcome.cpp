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
  keep(&Outcome::upper_bound);
  keep(&Outcome::spheres);
  keep(&Outcome::pairs);
  outcome = std::move(empty);
}

void keep_done_discs(Outcome& outcome) {
  outcome.standard_error.clear();
  outcome.upper_bound.clear();
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
