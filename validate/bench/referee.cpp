#include "referee.hpp"

namespace detp::validate {

std::uint64_t RightHits::wrong_hits(std::span<const std::uint64_t> others) const {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) sum += hits[i] > others[i] ? hits[i] - others[i] : others[i] - hits[i];
  return sum;
}

std::optional<RightHits> right_hits(const Job& job, const Candidate& exact, double checkable,
                                    const std::stop_token& stop) {
  const double pairs = static_cast<double>(job.rays.size()) * static_cast<double>(job.discs.size());
  const Candidate judge = pairs <= checkable ? Candidate{Technique::brute_force, BruteForceParameters{}} : exact;
  sim::Outcome outcome = sim::run(job.problem(), judge, {.count = false, .stop = stop, .threads = 0});
  if (outcome.stopped) return std::nullopt;
  return RightHits{judge.technique, std::move(outcome.hits)};
}

}  // namespace detp::validate
