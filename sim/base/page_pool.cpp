#include "page_pool.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <cstdint>
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

constexpr std::size_t pool_alignment = 64;
constexpr std::size_t small_page = 4096;
constexpr std::size_t large_page = std::size_t{1} << 21;
constexpr std::size_t least_block = std::size_t{1} << 15;     ///< smaller blocks come from the heap
constexpr std::size_t mapped_at_once = std::size_t{1} << 26;  ///< addresses; pages are not touched

#ifdef DETP_POOL_ON_HEAP
constexpr bool on_heap = true;  // so that the sanitizer sees the ends of arrays
#else
constexpr bool on_heap = false;
#endif

std::size_t rounded_up(std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; }

/// Addresses for `bytes`, a multiple of large_page; null if there are none.
char* mapped(std::size_t bytes) {
  void* const start =
      mmap(nullptr, bytes + large_page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (start == MAP_FAILED) return nullptr;
  const std::size_t before = (large_page - reinterpret_cast<std::uintptr_t>(start) % large_page) % large_page;
  char* const aligned = static_cast<char*>(start) + before;
  if (before > 0) munmap(start, before);
  munmap(aligned + bytes, large_page - before);
  return aligned;
}

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
  /// Free memory. Of its pages at most `touched` bytes may have been touched.
  struct Range {
    std::size_t bytes;
    std::size_t touched;
  };
  using Ranges = std::map<char*, Range>;

  static bool small(std::size_t bytes) { return on_heap || bytes < least_block; }

  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    if (alignment > pool_alignment) throw std::bad_alloc();
    if (small(bytes)) return ::operator new (bytes, std::align_val_t{pool_alignment});
    const std::size_t size = rounded_up(bytes, pool_alignment);
    const std::lock_guard lock(mutex_);
    auto fitting = by_size_.lower_bound({size, nullptr});
    if (fitting == by_size_.end()) {
      map(size);
      fitting = by_size_.lower_bound({size, nullptr});
    }
    char* const start = fitting->second;
    const Range range = taken(free_.find(start));
    const std::size_t touched = std::min(range.touched, size);
    if (range.bytes > size) insert(start + size, {range.bytes - size, range.touched - touched});
    return start;
  }

  void do_deallocate(void* block, std::size_t bytes, std::size_t) override {
    if (small(bytes)) return ::operator delete (block, std::align_val_t{pool_alignment});
    const std::size_t size = rounded_up(bytes, pool_alignment);
    const std::lock_guard lock(mutex_);
    char* start = static_cast<char*>(block);
    Range range{size, size};
    const auto after = free_.find(start + size);
    if (after != free_.end()) add(range, taken(after));
    auto before = free_.lower_bound(start);
    if (before != free_.begin() && (--before)->first + before->second.bytes == start) {
      start = before->first;
      add(range, taken(before));
    }
    insert(start, range);
    keep(memory_limit_is_set() ? 0 : most_kept_bytes);
  }

  [[nodiscard]] bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }

  static void add(Range& range, const Range& more) {
    range.bytes += more.bytes;
    range.touched += more.touched;
  }

  void insert(char* start, const Range& range) {
    free_.emplace(start, range);
    by_size_.emplace(range.bytes, start);
    kept_ += range.touched;
  }

  Range taken(Ranges::iterator free) {
    const Range range = free->second;
    by_size_.erase({range.bytes, free->first});
    free_.erase(free);
    kept_ -= range.touched;
    return range;
  }

  void map(std::size_t bytes) {
    std::size_t size = std::max(rounded_up(bytes, large_page), mapped_at_once);
    char* start = mapped(size);
    if (start == nullptr) start = mapped(size = rounded_up(bytes, large_page));
    if (start == nullptr) throw std::bad_alloc();
    insert(start, {size, 0});
  }

  /// Returns the largest free ranges to the system, until at most `most` bytes are kept.
  void keep(std::size_t most) {
    for (auto range = by_size_.rbegin(); kept_ > most && range != by_size_.rend(); ++range) {
      Range& free = free_.find(range->second)->second;
      if (free.touched == 0) continue;
      char* const start = range->second;
      const std::size_t before = (small_page - reinterpret_cast<std::uintptr_t>(start) % small_page) % small_page;
      if (before + small_page > free.bytes) continue;
      madvise(start + before, (free.bytes - before) / small_page * small_page, MADV_DONTNEED);
      kept_ -= free.touched;
      free.touched = 0;
    }
  }

  std::mutex mutex_;
  Ranges free_;
  std::set<std::pair<std::size_t, char*>> by_size_;  ///< of free_
  std::size_t kept_ = 0;                             ///< sum of `touched`
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
