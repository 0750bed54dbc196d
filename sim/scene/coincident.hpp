#pragma once

#include <stop_token>

#include "mesh.hpp"

namespace detp::sim {

/// Makes coincident surfaces one: afterwards the triangles cover the union of the surfaces once.
///
/// Two triangles coincide where they lie in one plane and overlap, whatever way they face, within 10⁻⁹ of the diagonal of
/// the box around the used vertices, or the rounding of coordinates if that is more. An overlap that is no wider is none:
/// neighbours do not coincide. Triangles without area are left alone, and those that are no higher than this unless they
/// have the same corners as others.
///
/// Of coincident triangles the one that emits more comes first, then the one with the lower number. The first stays as it
/// is, in its own groups only. Of each later one remains what no earlier one covers, as triangles in its place and in its
/// groups; their new corners are added at the end of the positions, with zero normals. A later triangle that faces the
/// other way gives its material to the first one's back (Materials::of_back) if it is another one or emits; the first is
/// divided if this is so for a part. Without coincident triangles the mesh stays as it is.
///
/// Sets mesh.coincident; adds notices if there are such triangles, and if they emit on the same side. The result depends
/// on the mesh alone. Cost O(n log n) and the work at the overlaps. Coordinates may be of any size. Throws Stopped if a
/// stop was requested.
void join_coincident(Mesh& mesh, Notices& notices, const std::stop_token& stop = {});

}  // namespace detp::sim
