#include "unit_costs.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace detp {

void check(const UnitCosts& costs) {
  // Counts reach about 1e55 (n_R n_P k), so no time overflows.
  constexpr double largest_cost = 1e200;
  for (const UnitCostTerm& term : unit_cost_terms)
    if (const double cost = costs.*term.cost; !(cost >= 0 && cost <= largest_cost))
      throw std::invalid_argument(fmt::format("the time of {} ({}) must be from 0 to {} (got {})", term.meaning,
                                              term.symbol, largest_cost, cost));
}

}  // namespace detp
