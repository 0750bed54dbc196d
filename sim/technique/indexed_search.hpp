#pragma once

#include "hit_collector.hpp"

namespace detp::sim {

/// Tests a ray against the discs of the cells it enters. A disc met in several cells is tested in each, but its hit is
/// kept once (what is tested again counts again, though the answer is known).
template <bool counting>
class IndexedSearch {
 public:
  IndexedSearch(const Problem& problem, const RunOptions& options)
      : problem_(problem), collector_(problem, options), last_ray_(problem.discs.size(), 0) {}

  /// Counts a visit to a cell (steps) or a node (nodes).
  void visit(std::uint64_t Counts<std::uint64_t>::*term) { tally_.add(term); }

  void test(std::uint32_t ray, std::span<const std::uint32_t> discs) {
    const Ray& tested = problem_.rays[ray];
    for (const std::uint32_t disc : discs)
      if (last_ray_[disc] != ray + 1 && collector_.decide(tested, problem_.discs[disc])) {
        last_ray_[disc] = ray + 1;
        collector_.keep(ray, disc);
      }
    tally_.add(&Counts<std::uint64_t>::disc_tests, discs.size());
  }

  void give(Outcome& outcome, std::size_t references, std::size_t placements) && {
    tally_.add(&Counts<std::uint64_t>::references, references);
    tally_.add(&Counts<std::uint64_t>::placements, placements);
    outcome.counts = tally_.counts();
    std::move(collector_).give(outcome);
  }

 private:
  const Problem& problem_;
  HitCollector collector_;
  Tally<counting> tally_;
  std::vector<std::uint32_t> last_ray_;  ///< for each disc: 1 + the last ray that hit it; 0: none yet
};

/// Traces every ray through an index, asking for a stop between blocks of them. An index offers trace(ray, search),
/// references() and placements().
template <bool counting, class Index>
void trace_all(const Index& index, const Problem& problem, const RunOptions& options, Outcome& outcome) {
  constexpr std::uint32_t block = 64;
  IndexedSearch<counting> search(problem, options);
  for (std::uint32_t ray = 0; ray < problem.rays.size() && !outcome.stopped; ++ray) {
    outcome.stopped = ray % block == 0 && options.stop.stop_requested();
    if (!outcome.stopped) index.trace(ray, search);
  }
  std::move(search).give(outcome, index.references(), index.placements());
}

template <class Index>
void search_index(const Index& index, const Problem& problem, const RunOptions& options, Outcome& outcome) {
  options.count ? trace_all<true>(index, problem, options, outcome)
                : trace_all<false>(index, problem, options, outcome);
}

/// The box around the discs' centres, grown by the largest radius: no disc pokes out.
[[nodiscard]] inline Box index_box(std::span<const Disc> discs) {
  Box box;
  double largest = 0;
  for (const Disc& disc : discs) {
    box.include(disc.centre);
    largest = std::max(largest, disc.radius);
  }
  return {box.low - largest, box.high + largest};
}

}  // namespace detp::sim
