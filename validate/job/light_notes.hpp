#pragma once

#include <string>
#include <vector>

#include "detp/sim/photons/light_ledger.hpp"
#include "detp/sim/scene/light.hpp"

/// Where the light of photon paths went, in words.
namespace detp::validate {

/// ", 38 % left the scene, 2 % was cut"; empty if at most a hundredth of the light did.
[[nodiscard]] std::string lost_light(const sim::LightLedger& light);

/// That more than a hundredth of the light of emitting surfaces met no surface, or that some was cut, and why that may be.
[[nodiscard]] std::vector<std::string> light_warnings(const sim::LightLedger& light,
                                                      const std::vector<sim::Light>& lights);

}  // namespace detp::validate
