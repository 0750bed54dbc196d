#pragma once

#include "detp/sim/scene/mesh.hpp"

namespace detp::support {

inline const sim::Box unit_box{{0, 0, 0}, {1, 1, 1}};

inline sim::Box box_of(const sim::Mesh& mesh) {
  sim::Box box;
  for (const glm::dvec3& position : mesh.positions) box.include(position);
  return box;
}

}  // namespace detp::support
