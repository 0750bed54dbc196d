#include "sample_dimension.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

namespace detp::sim {
namespace {

/// The cells that hold sampled points on one level.
struct Occupancy {
  double cells = 0;
  double once = 0;   ///< cells with one point
  double twice = 0;  ///< cells with two points

  /// Estimate of the cells that all points occupy: adds those in which the sample has none (Chao 1984).
  [[nodiscard]] double all_cells() const { return cells + once * (once - 1) / (2 * (twice + 1)); }

  /// Standard error of all_cells, relative to it (Chao 1987, for one or two points in a cell).
  [[nodiscard]] double relative_error() const {
    const double ratio = once / std::max(1.0, twice);
    return std::sqrt(twice * ratio * ratio * (0.5 + ratio * (1 + ratio / 4))) / all_cells();
  }
};

using Levels = std::array<Occupancy, levels_of_cells + 1>;

/// Counts cells by the level from which on neighbours in the order are in different cells.
Levels occupied_cells(const std::vector<std::uint64_t>& keys) {
  constexpr int never = 0;  // neighbours beyond both ends are apart on all levels
  std::vector<int> apart{never, never};
  for (std::size_t i = 1; i < keys.size(); ++i)
    apart.push_back((std::countl_zero(keys[i] ^ keys[i - 1]) - (64 - 3 * levels_of_cells)) / 3 + 1);
  apart.insert(apart.end(), {never, never});
  Levels levels;  // first the changes from level to level
  for (std::size_t i = 1; i + 2 < apart.size(); ++i) {
    const int alone = std::max(apart[i], apart[i + 1]);
    levels[static_cast<std::size_t>(apart[i])].cells += 1;
    levels[static_cast<std::size_t>(alone)].once += 1;
    const int two = std::max(apart[i - 1], apart[i + 1]);
    if (i == 1 || two >= apart[i]) continue;
    levels[static_cast<std::size_t>(two)].twice += 1;
    levels[static_cast<std::size_t>(apart[i])].twice -= 1;
  }
  for (std::size_t level = 1; level < levels.size(); ++level) {
    levels[level].cells += levels[level - 1].cells;
    levels[level].once += levels[level - 1].once;
    levels[level].twice += levels[level - 1].twice;
  }
  return levels;
}

}  // namespace

SampleDimension sample_dimension(std::vector<std::uint64_t> keys) {
  constexpr std::size_t least_points = 1024;
  constexpr double least_covered = 0.25;
  constexpr int last_level = levels_of_cells - 3;  // on finer ones, points that share a place would be missed
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  if (keys.size() < least_points) return {};
  const Levels levels = occupied_cells(keys);
  const auto covered = [&](std::size_t level) { return 1 - levels[level].once / static_cast<double>(keys.size()); };
  std::size_t last = 3;
  while (last < last_level && covered(last + 1) >= least_covered) ++last;
  // the slope of a least-squares line through three levels does not depend on the middle one
  const double slope = 0.5 * std::log2(levels[last].all_cells() / levels[last - 2].all_cells());
  const double error = std::hypot(levels[last].relative_error(), levels[last - 2].relative_error());
  return {std::clamp(slope, 1.0, 3.0), 0.5 * error / std::numbers::ln2};
}

}  // namespace detp::sim
