#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/scene/scene.hpp"
#include "detp/sim/scene/vertices.hpp"

namespace detp::sim {

struct SceneRequest {
  std::string name;                    ///< "@tree", "@room:7" (a seed) or a path
  std::optional<std::size_t> samples;  ///< number of samples; default: the number of vertices (@uniform: 100 000)
  std::uint64_t seed = 1;
  std::vector<LightKind> lights = {};  ///< none: the scene's own, or if it has none, an area light
  double crease = default_crease;      ///< degrees, for files without normals (vertices.hpp)
  bool rgb = false;                    ///< in the colours of its materials (Scene::rgb)
  std::optional<Up> up = {};           ///< none: Y in built-in scenes, found by up_of in files
};

/// The names of the built-in scenes, as in "@uniform, @tree, @room:SEED".
[[nodiscard]] std::string built_in_scenes();

/// Opens a built-in scene or a mesh file.
///
/// If `samples` is less than the number of vertices, keeps a random subset of the samples at vertices, in vertex order.
/// If it is greater, adds points distributed by area over the triangles, with the triangles' normals. The seed alone
/// determines the subset and the points. A file's own lights are the triangles
/// whose material emits; placed_lights places others. Throws FileError
/// as read_mesh does, and for a mesh that yields no sample or too few; std::invalid_argument for 0 samples and for an
/// unknown built-in name (the message lists the known ones). Throws Stopped within 0.1 s of a stop request.
[[nodiscard]] Scene open_scene(const SceneRequest& request, const std::stop_token& stop = {});

}  // namespace detp::sim
