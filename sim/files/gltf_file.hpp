#pragma once

#include <stop_token>
#include <string>

#include "detp/sim/scene/mesh.hpp"

namespace detp::sim {

/// Reads the triangles of a glTF 2.0 file: .gltf with its buffers, beside it or in it (base64), or .glb. Triangles, strips and fans of all
/// nodes of the default scene (without one: of all nodes), in their places; a mesh that several nodes have is there several times. Each triangle is in
/// the groups of its node's and its mesh's names.
///
/// Materials: base colour, metal, roughness, emission (also KHR_materials_emissive_strength) and transmission (KHR_materials_transmission,
/// KHR_materials_ior) as README.md says. Textures, lights and cameras, skins, morph targets and animations are left out, with a notice.
///
/// Throws FileError, with the JSON's place where it is known, for malformed files, a buffer that is missing or too short, references and indices
/// out of range, nodes that contain themselves, sparse accessors, and for required extensions that change the geometry (KHR_draco_mesh_compression, EXT_meshopt_compression, …);
/// std::length_error if the mesh would not fit in memory, and Stopped.
[[nodiscard]] Mesh read_gltf(const std::string& path, Notices& notices, std::stop_token stop = {});

/// Paths of the buffers that a .gltf file names; there may be no file there. Throws FileError.
[[nodiscard]] std::vector<std::string> gltf_buffers(const std::string& path, std::stop_token stop = {});

}  // namespace detp::sim
