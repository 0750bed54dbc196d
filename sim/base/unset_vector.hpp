#pragma once

#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace detp::sim {

/// An allocator whose elements keep whatever is in memory until they are set.
template <class T>
struct UnsetAllocator : std::allocator<T> {
  static_assert(std::is_trivially_default_constructible_v<T>);
  template <class Other>
  struct rebind {
    using other = UnsetAllocator<Other>;
  };
  template <class Element>
  void construct(Element* element) {
    ::new (static_cast<void*>(element)) Element;
  }
  template <class Element, class... Arguments>
  void construct(Element* element, Arguments&&... arguments) {
    ::new (static_cast<void*>(element)) Element(std::forward<Arguments>(arguments)...);
  }
};

/// A vector that does not clear its elements: for large arrays that are written at once, where clearing takes as long as writing.
template <class T>
using UnsetVector = std::vector<T, UnsetAllocator<T>>;

}  // namespace detp::sim
