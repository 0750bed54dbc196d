#pragma once

#include <string>
#include <vector>

#include "detp/sim/scene/light.hpp"
#include "light_ledger.hpp"

/// Where the light of photon paths went, in words.
namespace detp::sim {

/// ", 38 % left the scene, 2 % was cut"; empty if at most a hundredth of the light did.
[[nodiscard]] std::string lost_light(const LightLedger& light);

/// That more than a hundredth of the light of emitting surfaces met no surface, or that some was cut, and why that may be.
[[nodiscard]] std::vector<std::string> light_warnings(const LightLedger& light, const std::vector<Light>& lights);

}  // namespace detp::sim
