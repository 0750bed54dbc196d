#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "detp/model/vocabulary/quoted.hpp"
#include "memory.hpp"

namespace detp::sim {

/// Bounds the memory of what a reader keeps of one file: each vector that grows is checked before it does.
class KeptMemory {
 public:
  explicit KeptMemory(const std::string& path) : what_("what is kept of " + shown_path(path)) {}

  /// Adds to the vector. Throws std::length_error as require_memory does.
  template <class T>
  void push(std::vector<T>& to, T value) {
    if (to.size() == to.capacity()) reserve(to, std::max<std::size_t>(64, 2 * to.size()));
    to.push_back(std::move(value));
  }

  /// Makes room for that many in all. Throws likewise.
  template <class T>
  void reserve(std::vector<T>& vector, std::size_t count) {
    if (count <= vector.capacity()) return;
    const double more = static_cast<double>(sizeof(T)) * static_cast<double>(count);
    require_memory(what_, bytes_ + more);  // the old memory is there until the new is filled
    bytes_ += more - static_cast<double>(sizeof(T)) * static_cast<double>(vector.capacity());
    vector.reserve(count);
  }

 private:
  std::string what_;
  double bytes_ = 0;
};

}  // namespace detp::sim
