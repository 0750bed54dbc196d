#include "ranked.hpp"

#include <algorithm>
#include <numeric>

#include "detp/sim/base/memory.hpp"
#include "ranked_rays.hpp"

namespace detp::sim {
double imbalance(std::span<const double> seconds) {
  if (seconds.empty()) return 0;
  const double sum = std::accumulate(seconds.begin(), seconds.end(), 0.0);
  return *std::ranges::max_element(seconds) / (sum / static_cast<double>(seconds.size())) - 1;
}

RankedOutcome run_on_ranks(std::span<const Disc> discs, const RaySource& source, const Valid<Candidate>& candidate,
                           const StreamOptions& options, Ranks& ranks, Share divided) {
  if (ranks.count() == 1) return {run_in_memory(discs, source, candidate, options)};
  if (divided == Share::discs) return run_on_shared_discs(discs, source, candidate, options, ranks);
  return run_on_shared_rays(discs, source, candidate, options, ranks);
}

Share usual_share(std::size_t discs, int ranks) {
  constexpr double bytes = 400;  // of a disc with its results, a box tree, and totals of 2¹² blocks
  const bool fits = bytes * static_cast<double>(discs) <= memory_budget();
  return fits || discs < static_cast<std::size_t>(ranks) ? Share::rays : Share::discs;
}

}  // namespace detp::sim
