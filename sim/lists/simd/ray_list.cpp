#include "ray_list.hpp"

#include <algorithm>
#include <utility>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/page_pool.hpp"

namespace detp::sim::stream {

void clear_padding(RayList& list) {
  for (float* const array : {list.a, list.b, list.p, list.q, list.from, list.to})
    if (array != nullptr) std::fill_n(array + list.size, padding, 0.0F);
  std::fill_n(list.id + list.size, padding, 0U);
}

void ListArena::next_chunk(std::size_t most, bool segments) {
  constexpr std::size_t least = std::size_t{1} << 11;
  used_ = 0;
  if (!chunks_.empty() && chunk_ < chunks_.size()) ++chunk_;
  while (chunk_ < chunks_.size() && (most + padding > chunks_[chunk_].rays || (segments && !chunks_[chunk_].segments)))
    ++chunk_;
  if (chunk_ < chunks_.size()) return;
  // A seventh of 4 KiB more than a multiple of 4 KiB: a load waits for a store to an address with the same low twelve bits.
  const std::size_t rays =
      std::max({most + padding, least << std::min<std::size_t>(chunk_, 10), chunk_ == 0 ? expected_ : 0});
  const std::size_t stride = (rays + 1023) / 1024 * 1024 + 144;
  const std::size_t floats = stride * (segments ? 7 : 5);
  bytes_ += static_cast<double>(floats) * sizeof(float);
  require_memory("a thread's lists of rays", bytes_);
  std::pmr::memory_resource* const memory = chunks_.get_allocator().resource();
  const UntouchedBytes block = allocate_untouched(*memory, floats * sizeof(float));
  auto* const start = static_cast<float*>(block.start);
  chunks_.push_back({{start, {memory, floats}}, stride, stride, segments});
  const std::size_t touched = std::min(std::exchange(touched_, 0), rays);
  if (!block.fresh || touched == 0) return;
  for (std::size_t array = 0; array < floats; array += stride) touch_pages(start + array, touched * sizeof(float));
}

}  // namespace detp::sim::stream
