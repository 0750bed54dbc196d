#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "detp/sim/geometry.hpp"
#include "mesh.hpp"

namespace detp::sim {

/// Shines equally in all directions from a point.
struct PointLight {
  glm::dvec3 position{0.0};
};

/// A parallelogram that shines from one face, diffusely (cosine-distributed).
struct AreaLight {
  glm::dvec3 corner{0.0};
  glm::dvec3 edge_u{1.0, 0.0, 0.0};
  glm::dvec3 edge_v{0.0, 1.0, 0.0};  ///< it shines towards edge_u × edge_v
};

using Light = std::variant<PointLight, AreaLight>;

/// What the rays of a scene are by default.
enum class Field {
  isotropic,  ///< uniform isotropic lines through S₀
  photons     ///< photon paths from the light
};

/// A scene: where irradiance is wanted, and what light meets.
struct Scene {
  std::string name;             ///< "@tree", or the file's path
  Mesh mesh;                    ///< no triangles in @uniform
  std::vector<Sample> samples;  ///< at the mesh's vertices, or @uniform's points
  Box box;                      ///< of the samples and the mesh's used vertices; of @uniform, its cube
  std::optional<Light> light;   ///< none in @uniform
  double albedo = 0.5;          ///< share of a photon's meetings with a surface after which it goes on, diffusely
  Field field = Field::photons;
  Notices notices;
};

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

/// Mean length of the mesh's edges, each counted once; 0 without triangles. An estimate of the distance between
/// neighbouring samples at vertices. Throws Stopped if a stop was requested.
[[nodiscard]] double mean_edge_length(const Mesh& mesh, const std::stop_token& stop = {});

}  // namespace detp::sim
