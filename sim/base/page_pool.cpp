#include "page_pool.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <mutex>
#include <new>
#include <set>

#include "memory.hpp"

#if defined(__SANITIZE_ADDRESS__)
#define DETP_POOL_ON_HEAP 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(memory_sanitizer)
#define DETP_POOL_ON_HEAP 1
#endif
#endif

namespace detp::sim {
namespace {

constexpr std::size_t pool_alignment = 64;                 // bytes in a cache line
constexpr std::size_t least_block = std::size_t{1} << 15;  // smaller blocks come from the heap
constexpr std::size_t least_taken = std::size_t{1} << 18;  // from the heap at a time

#ifdef DETP_POOL_ON_HEAP
constexpr bool on_heap = true;  // so that the sanitizer sees the ends of arrays
#else
constexpr bool on_heap = false;
#endif

class PagePool final : public std::pmr::memory_resource {
 public:
  [[nodiscard]] std::size_t kept() {
    const std::lock_guard lock(mutex_);
    return kept_;
  }

  void release() {
    const std::lock_guard lock(mutex_);
    keep(0);
  }

 private:
  /// Free memory, part of what was taken from the heap at once.
  struct Range {
    std::size_t bytes;
    char* taken;
  };
  using Ranges = std::map<char*, Range>;

  static bool small(std::size_t bytes) { return on_heap || bytes < least_block; }
  static std::size_t rounded_up(std::size_t bytes) {
    return (bytes + pool_alignment - 1) / pool_alignment * pool_alignment;
  }

  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    if (alignment > pool_alignment) throw std::bad_alloc();
    if (small(bytes)) return ::operator new (bytes, std::align_val_t{pool_alignment});
    const std::size_t size = rounded_up(bytes);
    const std::lock_guard lock(mutex_);
    auto fitting = by_size_.lower_bound({size, nullptr});
    if (fitting == by_size_.end()) {
      take(size);
      fitting = by_size_.lower_bound({size, nullptr});
    }
    char* const start = fitting->second;
    const Range range = removed(free_.find(start));
    if (range.bytes > size) insert(start + size, {range.bytes - size, range.taken});
    taken_of_.emplace(start, range.taken);
    return start;
  }

  void do_deallocate(void* block, std::size_t bytes, std::size_t) override {
    if (small(bytes)) return ::operator delete (block, std::align_val_t{pool_alignment});
    const std::lock_guard lock(mutex_);
    char* start = static_cast<char*>(block);
    const auto own = taken_of_.find(start);
    Range range{rounded_up(bytes), own->second};
    taken_of_.erase(own);
    const auto after = free_.find(start + range.bytes);
    if (after != free_.end() && after->second.taken == range.taken) range.bytes += removed(after).bytes;
    auto before = free_.lower_bound(start);
    if (before != free_.begin() && (--before)->second.taken == range.taken &&
        before->first + before->second.bytes == start) {
      start = before->first;
      range.bytes += removed(before).bytes;
    }
    insert(start, range);
    keep(memory_limit_is_set() ? 0 : most_kept_bytes);
  }

  [[nodiscard]] bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }

  void insert(char* start, const Range& range) {
    free_.emplace(start, range);
    by_size_.emplace(range.bytes, start);
    kept_ += range.bytes;
  }

  Range removed(Ranges::iterator free) {
    const Range range = free->second;
    by_size_.erase({range.bytes, free->first});
    free_.erase(free);
    kept_ -= range.bytes;
    return range;
  }

  void take(std::size_t bytes) {
    const std::size_t size = std::max(bytes, least_taken);
    auto* const start = static_cast<char*>(::operator new (size, std::align_val_t{pool_alignment}));
    size_of_.emplace(start, size);
    insert(start, {size, start});
  }

  /// Returns to the heap what is free as a whole, the largest first, until at most `most` bytes are kept.
  void keep(std::size_t most) {
    for (auto next = by_size_.end(); kept_ > most && next != by_size_.begin();) {
      const auto [bytes, start] = *--next;
      const auto taken = size_of_.find(start);
      if (taken == size_of_.end() || taken->second != bytes) continue;
      next = std::next(next);
      (void)removed(free_.find(start));
      size_of_.erase(taken);
      ::operator delete (start, std::align_val_t{pool_alignment});
    }
  }

  std::mutex mutex_;
  Ranges free_;
  std::set<std::pair<std::size_t, char*>> by_size_;  ///< of free_
  std::map<char*, std::size_t> size_of_;             ///< what was taken from the heap
  std::map<char*, char*> taken_of_;                  ///< for each block in use
  std::size_t kept_ = 0;                             ///< bytes in free_
};

/// Never destroyed, because other static objects may have arrays in it.
PagePool& pool() {
  static PagePool& all = *new PagePool;
  return all;
}

}  // namespace

std::pmr::memory_resource& page_pool() { return pool(); }

std::size_t kept_bytes() { return pool().kept(); }

void release_kept_pages() { pool().release(); }

}  // namespace detp::sim
