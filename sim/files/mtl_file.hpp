#pragma once

#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "detp/sim/scene/mesh.hpp"

namespace detp::sim {

/// The file of that name in the folder of `path`; backslashes separate folders, too.
[[nodiscard]] std::string beside(const std::string& path, std::string_view name);

/// The materials of an MTL file. Colours become their luminance (Rec. 709: 0.2126 R + 0.7152 G + 0.0722 B); Material::colours keeps
/// them, with the filter Tf of glass.
///
/// Kd    diffuse share; Ke radiance; Ks specular share.
/// Ns    shininess; below 1, or with illum 0 or 1, Ks is ignored; from 1000, or with illum 3 or 5, a mirror.
/// d     opacity; without it 1 - Tr, without both 1. d 0, and Tr 1 without d unless illum is 3 or more, count as opaque: exporters
///       write them for opaque surfaces.
/// Glass the share 1 - opacity of the light goes through a boundary of index Ni (1.5 if it is not given, 1 or below 0.1); the other
///       shares are of the rest. illum alone makes no glass.
/// Kd and Ks of 1 or more together cannot be meant as shares: Kd is lowered to 0.98, Ks to half of what is then left of 0.98. A
/// single share of 1 is kept: the material absorbs nothing.
///
/// Each of these rules gives a notice with the names of materials. So do textures, which are ignored, colours other than RGB,
/// numbers out of range, and a file that is not there. Keywords may have other capitals. Throws FileError for a number that cannot
/// be read, for colours that are not finite or negative, and for a radiance below the range of normal doubles.
[[nodiscard]] std::vector<Material> read_mtl(const std::string& path, Notices& notices, std::stop_token stop = {});

}  // namespace detp::sim
