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
Growth published_growth(const GrowthCase& asked) {
  if (!is_tree_of_cells(asked.technique)) return {.power = third, .logarithms = 0};
  return {.power = 1 - 2 / asked.dimension, .logarithms = asked.technique == Technique::octree ? 1 : 0};
}

/// The corrected growth if the discs shrink.
Growth corrected_growth(const GrowthCase& asked) {
  if (asked.technique == Technique::grid) return {.power = third, .logarithms = 0};
  return {.power = 1 - 2 / asked.dimension, .logarithms = asked.dimension == 2 ? 1 : 0};
}

}  // namespace

Growth growth(const GrowthCase& asked) {
  if (!(asked.dimension >= 2 && asked.dimension <= 3))
    throw std::invalid_argument(fmt::format("sample dimension must be from 2 to 3 (got {})", asked.dimension));
  if (!is_known(asked.technique))
    throw std::invalid_argument(fmt::format("there is no closed form of {}", name(asked.technique)));
  const bool unsorted = asked.order == SampleOrder::none && !is_tree_of_cells(asked.technique);
  if (asked.technique == Technique::brute_force || unsorted || asked.disc == DiscRule::fixed) return proportional;
  const bool published = asked.form == Form::published || asked.technique == Technique::sphere_cache_published;
  return published ? published_growth(asked) : corrected_growth(asked);
}

}  // namespace detp::model
