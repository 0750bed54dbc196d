#pragma once

#include <cstddef>
#include <memory>
#include <memory_resource>
#include <type_traits>
#include <utility>
#include <vector>

/// Memory for large arrays, whose pages are kept from one search to the next.
namespace detp::sim {

/// Memory shared by the whole process, for arrays that live about as long as a search or an index. What is freed is kept for later
/// blocks: up to most_kept_bytes; nothing if a memory limit is set. Pages that are new are touched at once. A page of 4 KiB that is touched
/// alone for the first time took 1.3 or 10 µs (two kinds of virtual machines, Zen 5), and such pages a fifth to four fifths of the time of a search that takes
/// its memory from the heap; touched at once, half of the 10 µs. Small blocks come from the heap.
[[nodiscard]] std::pmr::memory_resource& page_pool();

inline constexpr std::size_t most_kept_bytes = std::size_t{1} << 27;

/// Freed bytes that the pool keeps.
[[nodiscard]] std::size_t kept_bytes();

/// Returns to the system what the pool keeps.
void release_kept_pages();

struct UntouchedBytes {
  void* start;
  bool fresh;  ///< some of its pages are new
};

/// A block of `memory`, aligned to a cache line, for arrays that may stay unused in part. If it comes from the pool, new pages are not touched.
[[nodiscard]] UntouchedBytes allocate_untouched(std::pmr::memory_resource& memory, std::size_t bytes);

inline constexpr std::size_t pool_alignment = 64;  ///< bytes in a cache line

/// Returns an array to the memory from which it was allocated.
template <class T>
struct ReturnTo {
  std::pmr::memory_resource* memory = nullptr;
  std::size_t count = 0;
  void operator()(T* start) const { memory->deallocate(start, count * sizeof(T), pool_alignment); }
};

template <class T>
using Untouched = std::unique_ptr<T[], ReturnTo<T>>;

/// Touches the whole pages among these bytes at once. Keeps what is in them.
void touch_pages(void* start, std::size_t bytes);

/// values.resize(count) for a vector that may be large: new pages are touched at once.
template <class T>
void resize_touched(std::vector<T>& values, std::size_t count) {
  constexpr std::size_t least_bytes = std::size_t{1} << 17;  // smaller arrays are rarely in new pages
  if (count > values.capacity() && count * sizeof(T) >= least_bytes) {
    values.reserve(count);
    touch_pages(values.data() + values.size(), (count - values.size()) * sizeof(T));
  }
  values.resize(count);
}

/// An allocator from the pool, whose elements keep whatever is in memory until they are set.
template <class T>
struct PoolAllocator {
  static_assert(std::is_trivially_default_constructible_v<T>);
  using value_type = T;

  PoolAllocator() = default;
  template <class Other>
  PoolAllocator(const PoolAllocator<Other>&) {}

  [[nodiscard]] T* allocate(std::size_t count) {
    return static_cast<T*>(page_pool().allocate(count * sizeof(T), alignof(T)));
  }
  void deallocate(T* start, std::size_t count) { page_pool().deallocate(start, count * sizeof(T), alignof(T)); }
  template <class Element>
  void construct(Element* element) {
    ::new (static_cast<void*>(element)) Element;
  }
  template <class Element, class... Arguments>
  void construct(Element* element, Arguments&&... arguments) {
    ::new (static_cast<void*>(element)) Element(std::forward<Arguments>(arguments)...);
  }
  bool operator==(const PoolAllocator&) const { return true; }
};

/// A vector in the pool that does not clear its elements: for large arrays that are written at once, where clearing takes as long as
/// writing.
template <class T>
using UnsetVector = std::vector<T, PoolAllocator<T>>;

}  // namespace detp::sim
