#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/sim/search/problem.hpp"

/// A few discs that lie far from the others.
namespace detp::validate {

struct FarDiscs {
  sim::Box near;        ///< the other discs have their centres in it
  double reach = 0;     ///< the longest side of the central box, or the usual diameter of a disc if that is larger
  std::size_t far = 0;  ///< number of discs far away

  [[nodiscard]] bool is_near(const sim::Disc& disc) const;
};

/// The discs that lie more than `reach` outside the central box, which holds the central 90 % of the centres on each axis;
/// nullopt unless the longest side of the box of all centres is over 4 times the reach. (1.0 to 2.4 times in 5 built-in
/// scenes and 20 meshes; 13 000 times in a scene made of two scales.) The central box and the usual diameter, a median,
/// are those of at most 1024 discs, evenly spaced in the array. Throws sim::Stopped if a stop was requested.
[[nodiscard]] std::optional<FarDiscs> find_far_discs(const sim::Problem& problem, const std::stop_token& stop = {});

/// At most 1024 discs, evenly spaced in the array.
[[nodiscard]] std::vector<sim::Disc> evenly_spaced(std::span<const sim::Disc> discs);

[[nodiscard]] double median_radius(const std::vector<sim::Disc>& discs);

}  // namespace detp::validate
