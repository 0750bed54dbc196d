#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "detp/sim/scene/material.hpp"

namespace detp::sim {

/// What of a file is not read, and how often.
using LeftOut = std::map<std::string, std::size_t>;

/// A material of glTF. With base colour c, metal m, roughness r, transmission t and index i, F = ((i - 1) / (i + 1))²:
///
///     diffuse   c (1 - m) (1 - t) (1 - F)
///     specular  c m + F (1 - m) (1 - t), with the exponent max(1, (1 / r⁴ - 1) / 2); a mirror below a roughness of 0.05
///     glass     t (1 - m)
///     emitted   emissiveFactor times emissiveStrength
///
/// The exponent is that of a lobe around the mirror direction about as wide as glTF's around the half vector (α = r²). Of a base colour with a texture, half the factor: the
/// texture is not read. Shares of more than 0.98 together are lowered to that. Numbers out of range are brought into it.
[[nodiscard]] Material gltf_material(const nlohmann::json& from, LeftOut& left_out);

}  // namespace detp::sim
