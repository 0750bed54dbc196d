#pragma once

#include <optional>
#include <variant>

#include "detp/model/vocabulary/ray_blocks.hpp"
#include "technique_model.hpp"

/// What the files in model/techniques share: a formula that takes a technique's own parameters becomes a prediction.
namespace detp::model {

/// The candidate's parameters, valid because the candidate was checked.
template <class P>
[[nodiscard]] Valid<P> checked_parameters(const Valid<Candidate>& candidate) {
  return Valid<P>(candidate, std::get<P>(candidate.parameters));
}

/// Calls a formula that takes the parameters of one technique, with those of the candidate.
template <class P, auto counts>
[[nodiscard]] Counts<double> predicted(const Valid<Workload>& workload, const Valid<Candidate>& candidate, Engine) {
  return counts(workload, checked_parameters<P>(candidate));
}

/// As `predicted`, for a technique with a simd engine whose formula counts the lists and visits of one block of rays.
template <class P, auto counts>
[[nodiscard]] Counts<double> in_blocks(const Valid<Workload>& workload, const Valid<Candidate>& candidate,
                                       Engine engine) {
  const auto& parameters = checked_parameters<P>(candidate);
  Counts<double> all = counts(workload, parameters);
  const RayBlocks blocks = ray_blocks(workload.rays, workload.samples, engine);
  if (blocks.count() == 1) return all;
  const auto of_block = [&](double rays) {
    Workload block = workload;
    block.rays = rays;
    return counts(Valid<Workload>(workload, block), parameters);
  };
  const Counts<double> full = of_block(blocks.size);
  all.culls = blocks.whole * full.culls;
  all.visits = blocks.whole * full.visits;
  if (blocks.last > 0) {
    const Counts<double> last = of_block(blocks.last);
    all.culls += last.culls;
    all.visits += last.visits;
  }
  return all;
}

template <class P>
[[nodiscard]] std::optional<FoundParameters> tuned(const std::optional<P>& best) {
  return best ? std::optional(FoundParameters{*best}) : std::nullopt;
}

/// Parameters with which the technique is slower than SearchLimits::fastest, as it would be with the best ones.
template <class P>
[[nodiscard]] std::optional<FoundParameters> not_tuned(const P& good) {
  return FoundParameters{good, {}, false};
}

}  // namespace detp::model
