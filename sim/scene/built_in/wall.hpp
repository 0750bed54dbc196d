#pragma once

#include "detp/sim/scene/mesh.hpp"

namespace detp::sim::built_in {

/// A straight upright wall. It is open at its ends, top and bottom, where other walls and floors meet it. Lengths are
/// in scene units.
struct Wall {
  glm::dvec3 corner;  ///< where it starts, on the face opposite to `out`
  glm::dvec3 along;   ///< horizontal unit vector
  glm::dvec3 out;     ///< horizontal unit vector, along × up
  double length;
  double height;
  double thickness;
};

/// A door, a window or an arch in the middle of a bay.
struct Opening {
  double width;
  double sill;       ///< height of its lower edge; 0: the floor
  double springing;  ///< height up to which its sides are straight
  double rise;       ///< height of the arch above `springing`; 0: a straight lintel
};

/// Adds both faces of the wall, cut into bays of equal length with an opening in each, and the inner faces of the
/// openings.
void add_wall(Mesh& mesh, const Wall& wall, int bays, const Opening& opening, double cell);

}  // namespace detp::sim::built_in
