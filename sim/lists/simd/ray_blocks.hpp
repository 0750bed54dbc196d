#pragma once

#include <utility>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/search/outcome.hpp"
#include "load_rays.hpp"

/// Reads the rays block by block.
namespace detp::sim::stream {

/// A block of rays, loaded.
class Block {
 public:
  explicit Block(std::pmr::memory_resource* memory) : arena_(memory) {}

  /// Loads up to `size` rays from number `first` on; none if there is no such ray.
  void load(const Problem& problem, const Frame& frame, std::size_t first, std::size_t size);

  [[nodiscard]] std::size_t first() const { return first_; }
  [[nodiscard]] std::size_t size() const { return size_; }  ///< including the rays that load_rays leaves out
  [[nodiscard]] const RayLists& lists() const { return lists_; }
  [[nodiscard]] const RayTraits& traits() const { return traits_; }

 private:
  ListArena arena_;
  RayLists lists_;
  RayTraits traits_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;  ///< of each list; not reduced for a smaller block, so that no other pages are touched
};

/// Calls search(block) for one block after another, until all are searched or a stop is requested. While a block is
/// searched, another thread, if there is one, loads the next block. Reports the share of the rays before each block.
template <class Search>
void for_each_block(const Problem& problem, const Frame& frame, const RunOptions& options, const Search& search) {
  const std::size_t size = rays_in_block(problem.discs().size());
  Block now(options.memory);
  Block next(options.memory);
  now.load(problem, frame, 0, size);
  while (now.first() < problem.rays().size()) {
    if (options.progress)
      options.progress(static_cast<double>(now.first()) / static_cast<double>(problem.rays().size()));
    if (options.stop.stop_requested()) break;
    sim::parallel_invoke([&] { next.load(problem, frame, now.first() + size, size); }, [&] { search(now); });
    std::swap(now, next);
  }
}

}  // namespace detp::sim::stream
