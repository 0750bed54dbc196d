#pragma once

#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "detp/sim/scene/mesh.hpp"

namespace detp::sim {

/// The file of that name in the folder of `path`; backslashes separate folders, too.
[[nodiscard]] std::string beside(const std::string& path, std::string_view name);

/// The materials of an MTL file. Colours become their luminance (Rec. 709: 0.2126 R + 0.7152 G + 0.0722 B).
///
/// Kd    diffuse share; Ke radiance; Ks specular share.
/// Ns    shininess; below 1, or with illum 0 or 1, Ks is ignored; from 1000, or with illum 3 or 5, a mirror.
/// Glass with illum 4, 6, 7 or 9, or if d < 1 (Tr > 0): the share 1 - d of the light, or all of it if illum says so and
///       d = 1, goes through a boundary of index Ni (1.5 if it is not given, 1 or below 0.1); the other shares are of the
///       rest.
/// If diffuse and specular shares add up to more than 1, both are scaled down. Textures are ignored. A file that is
/// not there gives no material and a notice, as do scaled shares and textures. Throws FileError for a number that cannot
/// be read, is not finite or negative, for a radiance below the range of normal doubles, and for a statement before the
/// first newmtl.
[[nodiscard]] std::vector<Material> read_mtl(const std::string& path, Notices& notices, std::stop_token stop = {});

}  // namespace detp::sim
