#include "growth.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace detp::model {
namespace {

constexpr Growth proportional{.power = 1, .logarithms = 0};
constexpr double third = 1.0 / 3;

bool is_tree_of_cells(Technique technique) { return technique == Technique::octree || technique == Technique::grid; }

/// Whether the technique is the paper's, or made of the same parts.
bool is_known(Technique technique) { return is_tree_of_cells(technique) || !record_of(technique).ray_by_ray; }

/// The published growth if the discs shrink.
Growth published_growth(const GrowthCase& growth_case) {
  if (!is_tree_of_cells(growth_case.technique)) return {.power = third, .logarithms = 0};
  return {.power = 1 - 2 / growth_case.dimension, .logarithms = growth_case.technique == Technique::octree ? 1 : 0};
}

/// The corrected growth if the discs shrink.
Growth corrected_growth(const GrowthCase& growth_case) {
  if (growth_case.technique == Technique::grid) return {.power = third, .logarithms = 0};
  return {.power = 1 - 2 / growth_case.dimension, .logarithms = growth_case.dimension == 2 ? 1 : 0};
}

}  // namespace

Growth growth(const GrowthCase& growth_case) {
  if (!(growth_case.dimension >= 2 && growth_case.dimension <= 3))
    throw std::invalid_argument(fmt::format("sample dimension must be from 2 to 3 (got {})", growth_case.dimension));
  if (!is_known(growth_case.technique))
    throw std::invalid_argument(fmt::format("there is no closed form of {}", name(growth_case.technique)));
  const bool unsorted = growth_case.order == SampleOrder::none && !is_tree_of_cells(growth_case.technique);
  if (growth_case.technique == Technique::brute_force || unsorted || growth_case.disc == DiscRule::fixed)
    return proportional;
  const bool published =
      growth_case.form == Form::published || growth_case.technique == Technique::sphere_cache_published;
  return published ? published_growth(growth_case) : corrected_growth(growth_case);
}

}  // namespace detp::model
