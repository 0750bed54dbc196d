#pragma once

#include <array>

#include "unit_costs.hpp"
#include "valid.hpp"

namespace detp {

/// The unit costs of each technique. The same operation may take a different time in each: the kernels, the sizes of
/// the lists and the memory in use differ.
struct CostTable {
  std::array<UnitCosts, all_techniques.size()> of_technique{};  ///< in the order of Technique

  CostTable() = default;
  /// The same costs for all techniques.
  CostTable(const UnitCosts& costs) { of_technique.fill(costs); }

  [[nodiscard]] UnitCosts& operator[](Technique technique) { return of_technique[static_cast<std::size_t>(technique)]; }
  [[nodiscard]] const UnitCosts& operator[](Technique technique) const {
    return of_technique[static_cast<std::size_t>(technique)];
  }

  bool operator==(const CostTable&) const = default;
};

/// Throws as check(UnitCosts); the message names the technique.
void check(const CostTable& costs);

/// The costs of one technique, which are valid because the table was checked.
[[nodiscard]] inline Valid<UnitCosts> costs_of(const Valid<CostTable>& costs, Technique technique) {
  return Valid<UnitCosts>(costs, costs[technique]);
}

/// The time of a technique's counts with its costs.
[[nodiscard]] inline CostBreakdown price(const Counts<double>& counts, const CostTable& costs, Technique technique) {
  return price(counts, costs[technique], technique);
}

}  // namespace detp
