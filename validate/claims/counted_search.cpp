#include "counted_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "batches.hpp"
#include "detp/sim/technique/technique.hpp"

namespace detp::validate {
namespace {

/// Distributes all rays over the batches in short runs of neighbouring rays. So the segments of one photon's path
/// mostly stay together, and each batch has rays from all parts of a sorted file.
std::vector<std::vector<sim::Ray>> distribute_over_batches(const std::vector<sim::Ray>& rays) {
  const std::size_t batches = std::min<std::size_t>(batch_count, rays.size());
  const std::size_t run = std::clamp<std::size_t>(rays.size() / batches, 1, 64);
  std::vector<std::vector<sim::Ray>> parts(batches);
  for (std::size_t i = 0; i < rays.size(); ++i) parts[i / run % batches].push_back(rays[i]);
  return parts;
}

}  // namespace

std::optional<CountedSearch> count_search(const Experiment& experiment, const Candidate& candidate, double share) {
  const ChoiceQuestion& question = *experiment.choice;
  const auto taken = static_cast<std::size_t>(std::ceil(share * static_cast<double>(question.rays.size())));
  // An evenly spaced sample.
  std::vector<sim::Ray> rays;
  for (std::size_t i = 0; i < taken; ++i) rays.push_back(question.rays[(i + 1) * question.rays.size() / taken - 1]);
  bool stopped = false;
  const auto counts_of = [&](const std::vector<sim::Ray>& some) {
    const sim::Problem problem = sim::make_problem(some, experiment.discs, question.workload.front_facing);
    const sim::Outcome outcome = sim::run(problem, candidate, {.stop = experiment.stop});
    if (outcome.stopped) stopped = true;
    return CountedBatch{static_cast<double>(some.size()), as_expected(outcome.counts)};
  };
  CountedSearch counted{.all = counts_of(rays)};
  for (const std::vector<sim::Ray>& batch : distribute_over_batches(rays)) counted.batches.push_back(counts_of(batch));
  if (stopped) return std::nullopt;
  return counted;
}

Estimate observed_in(const CountedSearch& counted, const std::function<double(const Counts<double>&)>& value,
                     double predicted, double rays) {
  const double scale = rays / counted.all.rays;
  Estimate estimate{scale * value(counted.all.counts), std::numeric_limits<double>::infinity()};
  if (counted.batches.size() < 2) return estimate;
  std::vector<double> parts;
  for (const CountedBatch& batch : counted.batches) parts.push_back(rays / batch.rays * value(batch.counts));
  estimate.standard_error = std::max(batch_means(parts).standard_error, std::sqrt(scale * predicted));
  return estimate;
}

int batches_in(const CountedSearch& counted) { return std::max(2, static_cast<int>(counted.batches.size())); }

}  // namespace detp::validate
