#include "mesh_light.hpp"

#include <algorithm>

namespace detp::sim {

AreaLight light_for(const Box& box) {
  const glm::dvec3 size = box.size();
  const double longest = std::max({size.x, size.y, size.z});
  const bool flat = size.y < 0.05 * longest;
  const double y = flat ? box.high.y + 0.5 * longest : box.high.y - 0.01 * size.y;
  const double along_x = std::max(0.5 * size.x, 0.05 * longest);
  const double along_z = std::max(0.5 * size.z, 0.05 * longest);
  const glm::dvec3 middle = box.centre();
  return {.corner = {middle.x - 0.5 * along_x, y, middle.z - 0.5 * along_z},
          .edge_u = {along_x, 0, 0},
          .edge_v = {0, 0, along_z}};
}

}  // namespace detp::sim
