#include "far_discs.hpp"

#include <algorithm>
#include <glm/vector_relational.hpp>
#include <vector>

#include "detp/sim/base/stop_check.hpp"

namespace detp::sim {
namespace {

/// Leaves out the lowest and the highest twentieth of the centres on each axis.
Box central_box(const std::vector<Disc>& discs) {
  const auto left_out = static_cast<std::ptrdiff_t>(discs.size() / 20);
  Box box;
  std::vector<double> values(discs.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(discs.begin(), discs.end(), values.begin(), [&](const Disc& disc) { return disc.centre[axis]; });
    const auto low = values.begin() + left_out;
    const auto high = values.end() - 1 - left_out;
    std::nth_element(values.begin(), low, values.end());
    box.low[axis] = *low;
    std::nth_element(values.begin(), high, values.end());
    box.high[axis] = *high;
  }
  return box;
}

}  // namespace

bool FarDiscs::is_near(const Disc& disc) const {
  return glm::all(glm::greaterThanEqual(disc.centre, near.low)) && glm::all(glm::lessThanEqual(disc.centre, near.high));
}

Spread spread_of(const Problem& problem) {
  const std::vector<Disc> sampled = evenly_spaced(problem.discs());
  Spread spread{.central = central_box(sampled)};
  spread.reach = std::max(spread.central.longest_side(), 2 * median_radius(sampled));
  spread.ratio = problem.centres().longest_side() / spread.reach;
  return spread;
}

FarDiscs discs_beyond(const Spread& spread, const Problem& problem, const std::stop_token& stop) {
  FarDiscs found{.near = {spread.central.low - spread.reach, spread.central.high + spread.reach},
                 .reach = spread.reach};
  StopCheck check(stop, "looking for outliers");
  for_each_checked(problem.discs(), check, [&](const Disc& disc) { found.far += found.is_near(disc) ? 0 : 1; });
  return found;
}

std::optional<FarDiscs> find_far_discs(const Problem& problem, const std::stop_token& stop) {
  const Spread spread = spread_of(problem);
  if (!(spread.ratio > far_ratio)) return std::nullopt;
  return discs_beyond(spread, problem, stop);
}

std::vector<Disc> evenly_spaced(std::span<const Disc> discs) {
  const std::size_t count = std::min<std::size_t>(1024, discs.size());
  std::vector<Disc> sampled;
  sampled.reserve(count);
  for (std::size_t i = 0; i < count; ++i) sampled.push_back(discs[i * discs.size() / count]);
  return sampled;
}

double median_radius(const std::vector<Disc>& discs) {
  std::vector<double> radii;
  for (const Disc& disc : discs) radii.push_back(disc.radius);
  std::sort(radii.begin(), radii.end());
  const std::size_t middle = radii.size() / 2;
  return radii.size() % 2 == 1 ? radii[middle] : 0.5 * (radii[middle - 1] + radii[middle]);
}

}  // namespace detp::sim
