#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "curve_sample.hpp"

namespace detp::sim {

/// Sampled discs that follow each other on the curve. Lengths are in the unit of the sample.
struct SampledNode {
  glm::vec3 low{0};  ///< of the box around the centres
  glm::vec3 high{0};
  glm::vec3 flattest{1};  ///< the smallest |n_i| of the normals along each axis
  std::uint32_t first = 0;
  std::uint32_t end = 0;
  std::uint32_t next = 0;  ///< the first node that is not below this one

  [[nodiscard]] std::uint32_t size() const { return end - first; }
};

/// Nodes of fewer discs are not split.
inline constexpr std::uint32_t least_split = 8;

/// The tree that the builder of box trees makes of the sampled discs, of which there is at least one: it splits them
/// where the curve leaves a cell. Depth first, beginning with the root.
[[nodiscard]] std::vector<SampledNode> sampled_tree(const CurveSample& sample);

}  // namespace detp::sim
