#include "built_in.hpp"

namespace detp::sim::built_in {

LitMesh square() {
  LitMesh lit_mesh;
  lit_mesh.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}};
  lit_mesh.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return lit_mesh;
}

}  // namespace detp::sim::built_in
