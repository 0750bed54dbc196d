#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/sim/search/problem.hpp"

/// A few discs that lie far from the others.
namespace detp::sim {

/// How far the centres of all discs are spread, compared with the central ones. Measured on at most 1024 discs, evenly
/// spaced in the array.
struct Spread {
  Box central;       ///< holds the central 90 % of the centres on each axis
  double reach = 0;  ///< the longest side of the central box, or the median diameter of a disc if that is larger
  double ratio = 0;  ///< longest side of the box of all centres, over the reach
};

[[nodiscard]] Spread spread_of(const Problem& problem);

/// The ratio above which discs are far from the others. (1.0 to 2.4 in 5 built-in scenes and 20 meshes; 13 000 in a scene
/// made of two scales.)
inline constexpr double far_ratio = 4;

struct FarDiscs {
  Box near;             ///< the other discs have their centres in it: the central box and the reach around it
  double reach = 0;     ///< that of the spread
  std::size_t far = 0;  ///< number of discs far away

  [[nodiscard]] bool is_near(const Disc& disc) const;
};

/// The discs that lie more than the reach outside the central box. Throws Stopped if a stop was requested.
[[nodiscard]] FarDiscs discs_beyond(const Spread& spread, const Problem& problem, const std::stop_token& stop = {});

/// The same; nullopt unless the ratio is above far_ratio.
[[nodiscard]] std::optional<FarDiscs> find_far_discs(const Problem& problem, const std::stop_token& stop = {});

/// At most 1024 discs, evenly spaced in the array.
[[nodiscard]] std::vector<Disc> evenly_spaced(std::span<const Disc> discs);

[[nodiscard]] double median_radius(const std::vector<Disc>& discs);

}  // namespace detp::sim
