#include "far_discs.hpp"

#include <algorithm>
#include <glm/vector_relational.hpp>
#include <vector>

#include "detp/sim/base/stop_check.hpp"
#include "detp/validate/statistics/statistics.hpp"

namespace detp::validate {
namespace {

constexpr double far_boxes = 4;

/// Leaves out the lowest and the highest twentieth of the centres on each axis.
sim::Box central_box(const std::vector<sim::Disc>& discs) {
  const auto left_out = static_cast<std::ptrdiff_t>(discs.size() / 20);
  sim::Box box;
  std::vector<double> values(discs.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(discs.begin(), discs.end(), values.begin(),
                   [&](const sim::Disc& disc) { return disc.centre[axis]; });
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

bool FarDiscs::is_near(const sim::Disc& disc) const {
  return glm::all(glm::greaterThanEqual(disc.centre, near.low)) && glm::all(glm::lessThanEqual(disc.centre, near.high));
}

std::optional<FarDiscs> find_far_discs(const sim::Problem& problem, const std::stop_token& stop) {
  FarDiscs found;
  const std::vector<sim::Disc> sampled = evenly_spaced(problem.discs());
  const sim::Box central = central_box(sampled);
  found.reach = std::max(central.longest_side(), 2 * median_radius(sampled));
  if (!(problem.centres().longest_side() > far_boxes * found.reach)) return std::nullopt;
  found.near = {central.low - found.reach, central.high + found.reach};
  sim::StopCheck check(stop, "looking for outliers");
  sim::for_each_checked(problem.discs(), check,
                        [&](const sim::Disc& disc) { found.far += found.is_near(disc) ? 0 : 1; });
  return found;
}

std::vector<sim::Disc> evenly_spaced(std::span<const sim::Disc> discs) {
  const std::size_t count = std::min<std::size_t>(1024, discs.size());
  std::vector<sim::Disc> sampled;
  sampled.reserve(count);
  for (std::size_t i = 0; i < count; ++i) sampled.push_back(discs[i * discs.size() / count]);
  return sampled;
}

double median_radius(const std::vector<sim::Disc>& discs) {
  std::vector<double> radii;
  for (const sim::Disc& disc : discs) radii.push_back(disc.radius);
  return median(std::move(radii));
}

}  // namespace detp::validate
