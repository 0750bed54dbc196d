#pragma once

#include <tbb/parallel_invoke.h>

#include <utility>

#include "load_rays.hpp"

/// The rays, block by block.
namespace detp::sim::stream {

/// Rays in a block: its lists (20 or 28 bytes a ray) stay in the second-level cache while they are culled.
inline constexpr std::size_t block_size = std::size_t{1} << 17;

/// A block of rays, loaded.
class Block {
 public:
  /// Loads the block that starts with that ray; nothing if there is none.
  void load(const Problem& problem, const Frame& frame, std::size_t first);

  [[nodiscard]] std::size_t first() const { return first_; }
  [[nodiscard]] const RayLists& lists() const { return lists_; }
  [[nodiscard]] const RayTraits& traits() const { return traits_; }

 private:
  ListArena arena_;
  RayLists lists_;
  RayTraits traits_;
  std::size_t first_ = 0;
};

/// Calls search(block) for one block after another, until all have been or the stop is asked for. The next one is
/// loaded meanwhile, if there is a thread for it.
template <class Search>
void for_each_block(const Problem& problem, const Frame& frame, const std::stop_token& stop, const Search& search) {
  Block now;
  Block next;
  now.load(problem, frame, 0);
  while (now.first() < problem.rays.size() && !stop.stop_requested()) {
    tbb::parallel_invoke([&] { next.load(problem, frame, now.first() + block_size); }, [&] { search(now); });
    std::swap(now, next);
  }
}

}  // namespace detp::sim::stream
