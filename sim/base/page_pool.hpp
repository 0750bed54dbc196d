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
/// blocks: up to most_kept_bytes; nothing if a memory limit is set. A page of 4 KiB that is touched for the first time took 1.3 µs
/// (a virtual machine, Zen 5), and such pages a fifth to a half of the time of a search that takes its memory from the heap. Small blocks come from there.
[[nodiscard]] std::pmr::memory_resource& page_pool();

inline constexpr std::size_t most_kept_bytes = std::size_t{1} << 27;

/// Freed bytes that the pool keeps.
[[nodiscard]] std::size_t kept_bytes();

/// Returns to the heap what the pool keeps, except next to blocks in use.
void release_kept_pages();

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
