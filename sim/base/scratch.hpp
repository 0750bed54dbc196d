#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <memory_resource>
#include <mutex>
#include <utility>

/// Memory that a search keeps for the next one.
namespace detp::sim {

/// A memory resource that keeps freed blocks and reuses them: a search that is repeated at the same size takes nothing
/// from page_pool. Sizes are rounded up to one of four sizes per octave; blocks are aligned to a cache line. The threads of one search may share a Scratch; simultaneous searches need
/// one each.
class Scratch final : public std::pmr::memory_resource {
 public:
  Scratch() = default;
  ~Scratch() override { release(); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  /// Call it before each search. Calls release() if the bytes taken from page_pool exceed twice the largest number of
  /// bytes in use at once since the last call.
  void begin();

  /// Frees the blocks that are not in use.
  void release();

  /// Bytes taken from page_pool and not returned.
  [[nodiscard]] std::size_t bytes() const { return held_; }

 private:
  struct Free {
    Free* next;
  };
  static constexpr std::size_t sizes = 256;

  void* do_allocate(std::size_t bytes, std::size_t alignment) override;
  void do_deallocate(void* block, std::size_t bytes, std::size_t alignment) override;
  [[nodiscard]] bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }

  std::mutex mutex_;
  std::array<Free*, sizes> free_{};  ///< lists of free blocks, by size
  std::size_t held_ = 0;             ///< bytes in use or free
  std::size_t used_ = 0;             ///< bytes in use
  std::size_t most_used_ = 0;        ///< since begin()
};

/// Destroys an object that make_in made, and returns its memory.
template <class T>
struct DeleteIn {
  std::pmr::memory_resource* memory = nullptr;
  std::size_t bytes = 0;  ///< of the object, which may be derived from T

  void operator()(T* object) const {
    object->~T();
    memory->deallocate(object, bytes);
  }
};

template <class T>
using OwnedIn = std::unique_ptr<T, DeleteIn<T>>;

/// Makes an object in memory of the resource, which must outlive the object. T's destructor must be virtual if Made is
/// derived from T.
template <class T, class Made = T, class... Arguments>
[[nodiscard]] OwnedIn<T> make_in(std::pmr::memory_resource& memory, Arguments&&... arguments) {
  void* const place = memory.allocate(sizeof(Made));
  try {
    return {new (place) Made(std::forward<Arguments>(arguments)...), DeleteIn<T>{&memory, sizeof(Made)}};
  } catch (...) {
    memory.deallocate(place, sizeof(Made));
    throw;
  }
}

}  // namespace detp::sim
