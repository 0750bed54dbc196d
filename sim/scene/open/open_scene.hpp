#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/scene/scene.hpp"

namespace detp::sim {

struct SceneRequest {
  std::string name;                    ///< "@tree" or a path
  std::optional<std::size_t> samples;  ///< how many; default: the vertices (@uniform: 100 000)
  std::uint64_t seed = 1;
};

/// The names of the built-in scenes, with '@'.
[[nodiscard]] const std::vector<std::string>& built_in_scenes();

/// Opens a built-in scene or a mesh file.
///
/// With `samples` fewer than the vertices, keeps a random subset of them in vertex order; with more, adds points
/// distributed by area over the triangles, with the triangles' normals. Either is a function of the seed alone.
/// The light of a mesh file hangs where light_for (mesh_light.hpp) says.
/// Throws FileError as read_mesh does, and for a mesh that gives no sample or too few; std::invalid_argument for 0
/// samples and for an unknown built-in name (the message lists the known ones). Throws Stopped within 0.1 s of a
/// stop request.
[[nodiscard]] Scene open_scene(const SceneRequest& request, const std::stop_token& stop = {});

}  // namespace detp::sim
