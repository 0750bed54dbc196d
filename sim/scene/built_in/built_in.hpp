#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "detp/sim/scene/scene.hpp"

/// The built-in scenes. Each is the same on every call: its random parts have a fixed seed. Y points up; all
/// but @cornell and @uniform are in metres.
namespace detp::sim::built_in {

/// A mesh and its lights.
struct LitMesh {
  Mesh mesh;
  std::vector<Light> lights;
  std::optional<double> known_irradiance = {};  ///< on all surfaces, by these lights
};

/// A broad tree on uneven ground: 72 500 triangles, edges 1 % of the scene's length on the tree, 2 % on the ground, as
/// in the paper's first scene. An area light as wide as the ground hangs over the tree.
[[nodiscard]] LitMesh tree();

/// A conifer on hilly ground: 18 000 triangles, with edges about twice as long as those of tree(). Lit like tree().
[[nodiscard]] LitMesh tree_coarse();

/// Two storeys of rooms behind arcades around an open court: about 120 000 triangles, mean edge 0.0133 of the scene's
/// length, as in the paper's third scene. The sky is an area light as wide as the court, at the height of the roof's
/// ridge.
[[nodiscard]] LitMesh courtyard();

/// A box of side 1, open in front (+Z), with two blocks in it. An area light just under the ceiling shines down. All surfaces reflect
/// half of the light; in colours (Scene::rgb) the left wall is red, the right one green.
[[nodiscard]] LitMesh cornell();

/// A glass ball and a brass ring on the floor before a wall: light is focused into caustics. Most of the light comes from
/// an area light; the spot that shines on the ball has a twentieth of it.
[[nodiscard]] LitMesh caustic();

/// A furnished room, 6 m by 5 m, closed but for two windows: table, chairs, shelf, sofa, a mirror, a glass. Five lights: a
/// lamp at the ceiling, one in a corner, a spot on the shelf, the sky and the sun outside of the windows.
[[nodiscard]] LitMesh interior();

/// A closed box of side 1. All walls emit a radiance of 1 diffusely and reflect half of the light: the irradiance is 2π
/// everywhere on them, E = π + E/2.
[[nodiscard]] LitMesh furnace();

/// A square floor of side 1 in parallel light that arrives 37° from the vertical. The irradiance is 1 everywhere on it: what
/// the floor reflects leaves the scene.
[[nodiscard]] LitMesh sunlit();

/// A new scene is a function above, with its file, and a line here.
struct BuiltIn {
  std::string_view name;
  LitMesh (*make)();  ///< null for samples without a mesh
};
inline constexpr std::array built_ins{
    BuiltIn{"@uniform", nullptr},     BuiltIn{"@tree", tree},       BuiltIn{"@tree-coarse", tree_coarse},
    BuiltIn{"@courtyard", courtyard}, BuiltIn{"@cornell", cornell}, BuiltIn{"@caustic", caustic},
    BuiltIn{"@interior", interior},   BuiltIn{"@furnace", furnace}, BuiltIn{"@sunlit", sunlit}};

/// A point uniform in the cube [-1, 1]³ with an isotropic normal, as a function of its number and of the seed.
[[nodiscard]] Sample uniform_sample(std::size_t number, std::uint64_t seed);
/// The first `count` of them. Throws Stopped if a stop was requested.
[[nodiscard]] std::vector<Sample> uniform_samples(std::size_t count, std::uint64_t seed,
                                                  const std::stop_token& stop = {});

}  // namespace detp::sim::built_in
