#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <vector>

#include "detp/sim/base/page_pool.hpp"
#include "frame.hpp"

/// Lists of rays as structures of arrays.
namespace detp::sim::stream {

/// Arrays are readable and writable this many floats beyond their end. The largest vector has no more floats than this.
inline constexpr std::size_t padding = 16;

/// Rays of one class, in rising order of their numbers. The arrays belong to a ListArena.
struct RayList {
  std::size_t size = 0;
  float* a = nullptr;           ///< dx/dz
  float* b = nullptr;           ///< dy/dz
  float* p = nullptr;           ///< x at z = 0
  float* q = nullptr;           ///< y at z = 0
  std::uint32_t* id = nullptr;  ///< number in the block; the top bit is set if the ray goes towards smaller z
  float* from = nullptr;        ///< segments only: the lower end's z; null in a list of lines
  float* to = nullptr;          ///< segments only: the upper end's z
};

inline constexpr std::uint32_t falling = 1U << 31;

/// The `count` rays of a list from position `first` on. `first` must be a multiple of `padding`.
[[nodiscard]] inline RayList part_of(const RayList& list, std::size_t first, std::size_t count) {
  const auto from = [first](auto* array) { return array == nullptr ? array : array + first; };
  return {count, from(list.a), from(list.b), from(list.p), from(list.q), from(list.id), from(list.from), from(list.to)};
}

/// Sets what the kernels read behind a list's end to zero.
void clear_padding(RayList& list);

/// Expected sizes of nested lists, as shares of the number of rays. A list has room for all rays of the list around it.
struct ListCapacity {
  double first = 0;  ///< rays in the outermost culled list
  double all = 0;    ///< `first`, plus the room of all lists inside that list
};

/// One list for each class.
using RayLists = std::array<RayList, classes>;

[[nodiscard]] inline std::size_t size(const RayLists& lists) { return lists[0].size + lists[1].size + lists[2].size; }

/// Memory for lists, last in, first out. A list that is culled starts where the list before it ends, so nested lists touch no more
/// pages than they fill. Throws std::length_error before the memory budget would be exceeded.
class ListArena {
 public:
  /// `expected` is the number of rays expected in all lists; the first chunk has room for at least this many. New pages for the first `touched`
  /// rays are touched at once.
  explicit ListArena(std::pmr::memory_resource* memory = std::pmr::new_delete_resource(), std::size_t expected = 0,
                     std::size_t touched = 0)
      : expected_(expected), touched_(touched), chunks_(memory) {}

  /// A list with room for `capacity` rays. New pages for the first `touched` are touched at once.
  [[nodiscard]] RayList allocate(std::size_t capacity, bool segments, std::size_t touched = 0) {
    touched_ = touched;
    const RayList list = next(capacity, segments);
    used_ += rounded(capacity + padding);
    return list;
  }

  /// A list with room for `most` rays, until the next call of a member function. To be filled, then kept.
  [[nodiscard]] RayList next(std::size_t most, bool segments) {
    if (chunk_ == chunks_.size() || used_ + most + padding > chunks_[chunk_].rays ||
        (segments && !chunks_[chunk_].segments))
      next_chunk(most, segments);
    const Chunk& chunk = chunks_[chunk_];
    float* const start = chunk.start.get() + used_;
    RayList list{.a = start, .b = start + chunk.stride, .p = start + 2 * chunk.stride, .q = start + 3 * chunk.stride};
    list.id = reinterpret_cast<std::uint32_t*>(start + 4 * chunk.stride);
    if (!segments) return list;
    list.from = start + 5 * chunk.stride;
    list.to = start + 6 * chunk.stride;
    return list;
  }

  /// Keeps the list of the latest call of next(), as it is filled.
  void keep(const RayList& list) { used_ += rounded(list.size); }

  struct Mark {
    std::size_t chunk;
    std::size_t used;
  };
  [[nodiscard]] Mark mark() const { return {chunk_, used_}; }

  /// Frees all lists allocated since the mark.
  void release(const Mark& mark) {
    chunk_ = mark.chunk;
    used_ = mark.used;
  }

 private:
  [[nodiscard]] static std::size_t rounded(std::size_t rays) { return (rays + padding - 1) / padding * padding; }
  void next_chunk(std::size_t most, bool segments);

  struct Chunk {
    Untouched<float> start;
    std::size_t rays;    ///< in each array
    std::size_t stride;  ///< floats from array to array
    bool segments;
  };
  std::size_t expected_;
  std::size_t touched_;  ///< of the next chunk
  std::pmr::vector<Chunk> chunks_;
  std::size_t chunk_ = 0;
  std::size_t used_ = 0;  ///< rays
  double bytes_ = 0;      ///< of all chunks
};

/// At the end of a scope, frees the lists allocated in that scope.
class ArenaScope {
 public:
  explicit ArenaScope(ListArena& arena) : arena_(arena), mark_(arena.mark()) {}
  ~ArenaScope() { arena_.release(mark_); }
  ArenaScope(const ArenaScope&) = delete;
  ArenaScope& operator=(const ArenaScope&) = delete;

 private:
  ListArena& arena_;
  ListArena::Mark mark_;
};

}  // namespace detp::sim::stream
