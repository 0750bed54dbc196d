#include "ranked.hpp"

#include <algorithm>
#include <numeric>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/ranks/parts.hpp"
#include "ranked_rays.hpp"

namespace detp::sim {
double imbalance(std::span<const double> seconds) {
  if (seconds.empty()) return 0;
  const double sum = std::accumulate(seconds.begin(), seconds.end(), 0.0);
  return *std::ranges::max_element(seconds) / (sum / static_cast<double>(seconds.size())) - 1;
}

RankedOutcome run_on_ranks(const DiscSource& discs, const RaySource& source, const Valid<Candidate>& candidate,
                           const StreamOptions& options, Ranks& ranks, Share share) {
  const std::span<const Disc> all = discs.in_memory();
  if (!all.empty() && ranks.count() > 1 && share == Share::rays)
    return run_on_shared_rays(all, source, candidate, options, ranks);
  if (!all.empty() && ranks.count() == 1) try {
      return {run_streamed(all, source, candidate, options)};
    } catch (const std::length_error&) {
      if (options.run.pairs) throw;
    }
  return run_on_shared_discs(discs, source, candidate, options, ranks);
}

RankedOutcome run_on_ranks(std::span<const Disc> discs, const RaySource& source, const Valid<Candidate>& candidate,
                           const StreamOptions& options, Ranks& ranks, Share share) {
  return run_on_ranks(DiscsInMemory(discs), source, candidate, options, ranks, share);
}

RankedOutcome run_in_parts(const DiscSource& discs, const RaySource& source, const Valid<Candidate>& candidate,
                           const StreamOptions& options, int parts) {
  OneRank one;
  return run_on_shared_discs(discs, source, candidate, options, one, static_cast<std::size_t>(parts));
}

Share usual_share(std::size_t discs, Ranks& ranks) {
  const bool fits = bytes_of_disc * static_cast<double>(discs) <= memory_budget();
  const bool all_fit = largest(ranks, fits ? 0 : 1) == 0;
  return all_fit || discs < static_cast<std::size_t>(ranks.count()) ? Share::rays : Share::discs;
}

}  // namespace detp::sim
