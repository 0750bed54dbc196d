#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "detp/model/vocabulary/quoted.hpp"
#include "memory.hpp"

namespace detp::sim {

/// Limits the memory of the data that a reader keeps of one file: before a vector grows, checks the total size of all
/// vectors.
class KeptMemory {
 public:
  explicit KeptMemory(const std::string& path) : what_("what is kept of " + shown_path(path)) {}

  /// Appends to the vector, which will have about `expected` elements (0: not known). Throws std::length_error as require_memory does.
  template <class T>
  void push(std::vector<T>& to, T value, std::size_t expected = 0) {
    if (to.size() == to.capacity())
      reserve(to, expected > to.size() ? expected : std::max<std::size_t>(64, 2 * to.size()));
    to.push_back(std::move(value));
  }

  /// Reserves room for `count` elements in all. Throws std::length_error as require_memory does.
  template <class T>
  void reserve(std::vector<T>& vector, std::size_t count) {
    if (count <= vector.capacity()) return;
    const double more = static_cast<double>(sizeof(T)) * static_cast<double>(count);
    require_memory(what_, bytes_ + more);  // the old array exists until the new one is filled
    bytes_ += more - static_cast<double>(sizeof(T)) * static_cast<double>(vector.capacity());
    vector.reserve(count);
  }

 private:
  std::string what_;
  double bytes_ = 0;
};

}  // namespace detp::sim
