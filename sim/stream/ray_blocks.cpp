#include "ray_blocks.hpp"

#include <algorithm>

namespace detp::sim::stream {

void Block::load(const Problem& problem, const Frame& frame, std::size_t first) {
  first_ = first;
  if (first >= problem.rays.size()) return;
  const auto rays = problem.rays.subspan(first, std::min(block_size, problem.rays.size() - first));
  arena_.release({});
  for (RayList& list : lists_) list = arena_.take(rays.size(), true);
  traits_ = load_rays(rays, frame, lists_);
}

}  // namespace detp::sim::stream
