#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"

/// Discs that break the models' assumptions, each in its own way.
namespace detp::validate {

enum class AwkwardScene {
  clusters,     ///< in 20 clusters of very different sizes in a cube
  tiny_object,  ///< half on a floor, half on a ball with a hundredth of the floor's side as diameter
  thin_sheet,   ///< in a plane
  strays,       ///< uniform in a cube, but five of them 300 times the cube's side away
  mixed_radii   ///< uniform in a cube, with log-normal radii: a factor of e is one standard deviation
};

/// "tiny-object".
[[nodiscard]] std::string_view name(AwkwardScene scene);

/// `count` discs with isotropic normals. `radius` is the (median) disc radius; the longest side of the cube, floor or
/// sheet is 1. Each disc is a function of the seed and of its number.
[[nodiscard]] std::vector<sim::Disc> awkward_discs(AwkwardScene scene, std::size_t count, double radius,
                                                   std::uint64_t seed);

}  // namespace detp::validate
