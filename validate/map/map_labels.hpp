#pragma once

#include <string>

#include "technique_map.hpp"

/// The words and numbers of a map, as text and picture show them.
namespace detp::validate {

/// 100 000 as "1e5", 12 345 as "1.23e4", 50 as "50".
[[nodiscard]] std::string rays_label(double rays);

/// "4 %", or the length "0.02".
[[nodiscard]] std::string radius_label(const Length& radius);

/// With two significant digits and a unit: "0.84 ms", "1.2 s".
[[nodiscard]] std::string seconds_label(double seconds);

/// "@tree: 85967 discs of dimension D = 2.13, photon paths". Requires at least one row.
[[nodiscard]] std::string describe(const TechniqueMap& map);

}  // namespace detp::validate
