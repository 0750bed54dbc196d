#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "detp/sim/scene/built_in/built_in.hpp"

/// Families of scenes. A seed determines all that is random in a scene: 2000 to 100 000 vertices, numbers and sizes of its parts, its
/// materials and lights. Y points up; all are in metres.
namespace detp::sim::families {

/// A furnished room, with or without windows; lit from the ceiling, by the sky, or both.
[[nodiscard]] built_in::LitMesh room(std::uint64_t seed);

/// A few trees and shrubs on uneven ground, under the sky or the sun.
[[nodiscard]] built_in::LitMesh plant(std::uint64_t seed);

/// A bench with blocks, shafts, balls and bent pipes, close together; lamps from above.
[[nodiscard]] built_in::LitMesh machine(std::uint64_t seed);

/// Hills and valleys, finer in one half than in the other, under the sky or the sun.
[[nodiscard]] built_in::LitMesh terrain(std::uint64_t seed);

/// Spheres inside each other with holes in them, around a lamp.
[[nodiscard]] built_in::LitMesh shells(std::uint64_t seed);

/// A wide floor, and on it small objects that have most of the vertices.
[[nodiscard]] built_in::LitMesh details(std::uint64_t seed);

struct Family {
  std::string_view name;  ///< "room"
  built_in::LitMesh (*make)(std::uint64_t seed);
};

inline constexpr std::array all_families{Family{"room", room},       Family{"plant", plant},
                                         Family{"machine", machine}, Family{"terrain", terrain},
                                         Family{"shells", shells},   Family{"details", details}};

}  // namespace detp::sim::families
