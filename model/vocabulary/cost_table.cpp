#include "cost_table.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace detp {

void check(const CostTable& costs) {
  for (const Technique technique : all_techniques) try {
      check(costs[technique]);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("{}: {}", name(technique), error.what()));
    }
}

}  // namespace detp
