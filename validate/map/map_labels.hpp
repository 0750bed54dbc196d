#pragma once

#include <string>

#include "technique_map.hpp"

/// The words and numbers of a map, as text and picture show them.
namespace detp::validate {

/// "4 %", or the length "0.02".
[[nodiscard]] std::string radius_label(const Length& radius);

/// "@tree: 85967 discs of dimension D = 2.13, photon paths". Requires at least one row.
[[nodiscard]] std::string describe(const TechniqueMap& map);

}  // namespace detp::validate
