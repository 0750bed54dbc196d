#include "surface.hpp"

namespace detp::sim {

std::unique_ptr<Index> prepare_toy_hits(const Mesh& mesh, const std::stop_token& stop,
                                        std::shared_ptr<const NearTriangles> triangles) {
  return prepare_triangle_hits(mesh, stop, std::move(triangles));
}

}  // namespace detp::sim
