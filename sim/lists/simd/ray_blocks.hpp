#pragma once

#include <algorithm>
#include <optional>
#include <utility>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "ray_list.hpp"

/// Reads the rays block by block.
namespace detp::sim::stream {

/// Common properties of rays.
struct RayTraits {
  bool segments = false;        ///< at least one ray is a segment
  std::optional<double> power;  ///< the power of each ray, if all powers are equal
};

/// Converts rays to the frame's coordinates and sorts them by class; their numbers start at `first_number`. Leaves out rays that
/// stay far from S₀. There must be at least one ray, and at most 2³¹. Each list must be empty and have room for all
/// rays, and for their ends unless all are lines. Fills the padding behind each list with zeros: the kernels compute with it, and whatever is in
/// reused memory may be subnormal numbers, with which a test of few rays takes ten times as long.
RayTraits load_rays(std::span<const Ray> rays, const Frame& frame, RayLists& lists, std::uint32_t first_number = 0);

/// A block of rays, loaded.
class Block {
 public:
  /// `keep_powers`: searches will need the powers of single rays.
  explicit Block(std::pmr::memory_resource* memory, bool keep_powers)
      : arena_(memory), powers_(memory), further_(memory), keep_powers_(keep_powers) {}

  /// Loads up to `size` rays from number `first` on, `pieces` parts of them at the same time; none if there is no such ray.
  void load(const Problem& problem, const Frame& frame, std::size_t first, std::size_t size, std::size_t pieces = 1);

  [[nodiscard]] std::size_t first() const { return first_; }
  [[nodiscard]] std::size_t size() const { return size_; }  ///< including the rays that load_rays leaves out
  [[nodiscard]] const RayLists& lists() const { return lists_; }
  [[nodiscard]] const RayTraits& traits() const { return traits_; }
  /// Powers of the rays by their numbers in the block; null unless kept. (Rays are 64 bytes apart: too far for the cache.)
  /// Of the same rays, a row for each.
  [[nodiscard]] const double* further_powers() const { return further_powers_; }
  [[nodiscard]] const double* powers() const { return keep_powers_ ? powers_.data() : nullptr; }

 private:
  ListArena arena_;
  RayLists lists_;
  RayTraits traits_;
  std::pmr::vector<double> powers_;
  std::pmr::vector<double> further_;  ///< a copy of the rows of powers in further bands, if it is worth it
  const double* further_powers_ = nullptr;
  bool keep_powers_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;  ///< of each list; not reduced for a smaller block, so that no other pages are touched
};

/// In how many pieces so many threads load the first block, of so many rays.
[[nodiscard]] inline std::size_t pieces_of_block(std::size_t rays, int threads) {
  constexpr std::size_t least_piece = std::size_t{1} << 13;
  return std::clamp<std::size_t>(rays / least_piece, 1, static_cast<std::size_t>(threads));
}

/// Whether powers of single rays are needed; if not, it is enough to count hits.
[[nodiscard]] bool needs_powers(const Problem& problem, const RunOptions& options);

/// Calls search(block) for one block after another, until all are searched or a stop is requested. All photons of a block
/// of rays are in one block of photons (photon_sums.hpp). While a block is searched, another thread, if there is one, loads the
/// next block. Reports the share of the rays before each block.
template <class Search>
void for_each_block(const Problem& problem, const Frame& frame, const RunOptions& options, const Search& search) {
  const std::size_t most = rays_in_block(problem.discs().size());
  const std::uint64_t first_photon = detp::sim::first_photon(options);
  const PhotonBlocks blocks = photon_blocks(problem, options);
  const auto size_at = [&](std::size_t first) {
    const std::size_t rays = problem.rays().size();
    return first < rays ? problem.end_of_block(first, std::min(first + most, rays), first_photon, blocks) - first : 0;
  };
  const bool keep_powers = needs_powers(problem, options);
  Block now(options.memory, keep_powers);
  Block next(options.memory, keep_powers);
  const int threads = thread_count(options.threads);
  const bool alone = threads == 1;
  now.load(problem, frame, 0, size_at(0), pieces_of_block(size_at(0), threads));
  while (now.first() < problem.rays().size()) {
    if (options.progress)
      options.progress(static_cast<double>(now.first()) / static_cast<double>(problem.rays().size()));
    if (options.stop.stop_requested()) break;
    const std::size_t end = now.first() + now.size();
    if (alone) {
      search(now);
      now.load(problem, frame, end, size_at(end));
      continue;
    }
    sim::parallel_invoke([&] { next.load(problem, frame, end, size_at(end)); }, [&] { search(now); });
    std::swap(now, next);
  }
}

}  // namespace detp::sim::stream
