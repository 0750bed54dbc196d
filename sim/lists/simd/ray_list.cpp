#include "ray_list.hpp"

#include <algorithm>

#include "detp/sim/base/memory.hpp"

namespace detp::sim::stream {
namespace {

constexpr std::size_t line = 16;  // floats in a cache line

/// Floats from array to array: an odd number of cache lines, so that the arrays do not fall on the same cache sets.
std::size_t stride_for(std::size_t capacity) {
  const std::size_t lines = (capacity + padding + line - 1) / line;
  return (lines | 1) * line;
}

}  // namespace

RayList ListArena::allocate(std::size_t capacity, bool segments) {
  const std::size_t stride = stride_for(capacity);
  float* const start = allocate_floats(stride * (segments ? 7 : 5));
  RayList list{.a = start, .b = start + stride, .p = start + 2 * stride, .q = start + 3 * stride};
  list.id = reinterpret_cast<std::uint32_t*>(start + 4 * stride);
  if (segments) {
    list.from = start + 5 * stride;
    list.to = start + 6 * stride;
  }
  return list;
}

float* ListArena::allocate_floats(std::size_t count) {
  constexpr std::size_t least = std::size_t{1} << 14;
  while (chunk_ < chunks_.size() && used_ + count > chunks_[chunk_].size) {
    ++chunk_;
    used_ = 0;
  }
  if (chunk_ == chunks_.size()) {
    const std::size_t size = std::max({count, least << std::min<std::size_t>(chunk_, 10), chunk_ == 0 ? expected_ : 0});
    bytes_ += static_cast<double>(size) * sizeof(float);
    require_memory("a thread's lists of rays", bytes_);
    std::pmr::memory_resource* const memory = chunks_.get_allocator().resource();
    void* const start = memory->allocate(size * sizeof(float), alignment);
    chunks_.push_back({{static_cast<float*>(start), Deallocate{memory, size}}, size});
  }
  float* const taken = chunks_[chunk_].start.get() + used_;
  used_ += count;
  return taken;
}

}  // namespace detp::sim::stream
