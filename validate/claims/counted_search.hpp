#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "claim.hpp"

/// Counts of searches of the rays for which a choice is made.
namespace detp::validate {

struct CountedBatch {
  double rays = 0;
  Counts<double> counts;
};

/// The counts of some of the rays, and of parts of these.
struct CountedSearch {
  CountedBatch all;
  std::vector<CountedBatch> batches = {};  ///< at most batch_count, each with rays from everywhere
};

/// Searches this share of the rays of experiment.choice, which must be set: first all of them at once, then in parts.
/// Returns nothing after a stop request.
[[nodiscard]] std::optional<CountedSearch> count_search(const Experiment& experiment, const Candidate& candidate,
                                                        double share = 1);

/// The value for `rays` rays, scaled from the counted ones. It must add up over rays. The standard error is that between
/// the batches, but at least that of independent events whose expected number is `predicted`; infinite if there is a
/// single ray.
[[nodiscard]] Estimate observed_in(const CountedSearch& counted,
                                   const std::function<double(const Counts<double>&)>& value, double predicted,
                                   double rays);

/// The number of batches from which observed_in has its standard error.
[[nodiscard]] int batches_in(const CountedSearch& counted);

}  // namespace detp::validate
