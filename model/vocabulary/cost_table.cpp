#include "cost_table.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "checks.hpp"

namespace detp {

void check(const CostTable& costs) {
  for (const Technique technique : all_techniques) try {
      check(costs[technique]);
      check(costs.threads_of(technique));
      require_non_negative("relative error", costs.relative_error_of(technique));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("{}: {}", name(technique), error.what()));
    }
}

namespace {

/// The time on one thread. UnitCosts::far of discs that are visited again for each block of rays belongs to the search, not
/// to building, because threads divide these phases differently.
CostBreakdown price_on_one(const Counts<double>& counts, const UnitCosts& costs, Technique technique) {
  CostBreakdown time = price(counts, costs, technique);
  const double again =
      costs.far *
      (far_discs(counts) -
       far_discs({.references = counts.references, .placements = counts.placements, .sorted = counts.sorted}));
  time.build -= again;
  time.intersect += again;
  return time;
}

}  // namespace

CostBreakdown price(const Counts<double>& counts, const CostTable& costs, Technique technique, int threads) {
  return on_threads(price_on_one(counts, costs[technique], technique), pieces_of(counts, technique, costs.engine),
                    costs.threads_of(technique), threads);
}

TimeOnThreads fastest_price(const Counts<double>& counts, const CostTable& costs, Technique technique,
                            int most_threads) {
  const CostBreakdown one = price_on_one(counts, costs[technique], technique);
  const Pieces pieces = pieces_of(counts, technique, costs.engine);
  TimeOnThreads best{1, one};
  for (const int threads : thread_numbers(most_threads))
    if (const CostBreakdown time = on_threads(one, pieces, costs.threads_of(technique), threads);
        time.total() < best.time.total())
      best = {threads, time};
  return best;
}

}  // namespace detp
