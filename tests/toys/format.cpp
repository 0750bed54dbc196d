#include <fstream>
#include <stop_token>
#include <string>

#include "detp/sim/scene/mesh.hpp"

namespace detp::sim {

/// Three numbers a corner, three corners a triangle.
Mesh read_corners(const std::string& path, Notices&, std::stop_token) {
  Mesh mesh;
  std::ifstream file(path);
  for (glm::dvec3 corner(0.0); file >> corner.x >> corner.y >> corner.z;) mesh.positions.push_back(corner);
  for (std::uint32_t i = 0; i + 2 < mesh.positions.size(); i += 3) mesh.triangles.push_back({i, i + 1, i + 2});
  return mesh;
}

}  // namespace detp::sim
