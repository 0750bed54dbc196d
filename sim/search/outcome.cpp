#include "outcome.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace detp::sim {

void clear(Outcome& outcome) {
  Outcome empty;
  const auto keep = [&](auto array) {
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

void add_block(const Outcome& part, Outcome& sum) {
  sum.counts += part.counts;
  sum.vectors += part.vectors;
  sum.total_hits += part.total_hits;
  sum.stopped = part.stopped;
  sum.batches += part.batches;
  sum.seconds.build += part.seconds.build;
  sum.seconds.search += part.seconds.search;
  sum.spheres.resize(std::max(sum.spheres.size(), part.spheres.size()));
  for (std::size_t i = 0; i < part.spheres.size(); ++i) {
    sum.spheres[i].rebuilds += part.spheres[i].rebuilds;
    sum.spheres[i].tests += part.spheres[i].tests;
    sum.spheres[i].listed += part.spheres[i].listed;
  }
}

void keep_done_discs(Outcome& outcome) {
  outcome.clear_errors();
  outcome.progress = {0, outcome.done_discs.size(), "discs"};
  outcome.total_hits = 0;
  for (std::size_t disc = 0; disc < outcome.done_discs.size(); ++disc) {
    if (!outcome.done_discs[disc]) outcome.hits[disc] = 0;
    for (std::size_t band = 0; band < outcome.bands(); ++band)
      if (!outcome.done_discs[disc]) outcome.band(band).irradiance[disc] = 0;
    outcome.progress.done += outcome.done_discs[disc] ? 1 : 0;
    outcome.total_hits += outcome.hits[disc];
  }
  outcome.counts.hits = outcome.total_hits;
}

void Batches::add(std::uint64_t batch_rays, double of_batch) {
  ++count;
  rays += batch_rays;
  sum += of_batch;
  squares += of_batch * of_batch / static_cast<double>(batch_rays);
}

Batches& Batches::operator+=(const Batches& other) {
  count += other.count;
  rays += other.rays;
  sum += other.sum;
  squares += other.squares;
  return *this;
}

SumEstimate estimate_sum(const Batches& batches, std::uint64_t all_rays) {
  const auto n = static_cast<double>(batches.rays);
  const auto all = static_cast<double>(all_rays);
  SumEstimate estimate{batches.sum * all / n, std::nullopt};
  if (batches.count < 2) return estimate;
  const double variance =
      std::max(0.0, batches.squares - batches.sum * batches.sum / n) / static_cast<double>(batches.count - 1);
  estimate.standard_error = std::sqrt(all * std::max(0.0, all - n) / n * variance);
  return estimate;
}

}  // namespace detp::sim
