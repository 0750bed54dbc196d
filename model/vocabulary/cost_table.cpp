#include "cost_table.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace detp {

void check(const CostTable& costs) {
  for (const Technique technique : all_techniques) try {
      check(costs[technique]);
      check(costs.threads_of(technique));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("{}: {}", name(technique), error.what()));
    }
}

CostBreakdown price(const Counts<double>& counts, const CostTable& costs, Technique technique, int threads) {
  return on_threads(price(counts, costs[technique], technique), pieces_of(counts, technique, costs.engine),
                    costs.threads_of(technique), threads);
}

TimeOnThreads fastest_price(const Counts<double>& counts, const CostTable& costs, Technique technique,
                            int most_threads) {
  const CostBreakdown one = price(counts, costs[technique], technique);
  const Pieces pieces = pieces_of(counts, technique, costs.engine);
  TimeOnThreads best{1, one};
  for (const int threads : thread_numbers(most_threads))
    if (const CostBreakdown time = on_threads(one, pieces, costs.threads_of(technique), threads);
        time.total() < best.time.total())
      best = {threads, time};
  return best;
}

}  // namespace detp
