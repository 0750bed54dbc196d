#include "page_pool.hpp"

#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

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

constexpr std::size_t least_block = std::size_t{1} << 15;  // smaller blocks come from the heap
constexpr std::size_t growth = std::size_t{1} << 20;
constexpr std::size_t most_touched_at_once = std::size_t{1} << 28;  // about 50 ms; more would delay a stop

#ifdef DETP_POOL_ON_HEAP
constexpr bool on_heap = true;  // so that the sanitizer sees the ends of arrays
#else
constexpr bool on_heap = false;
#endif

std::size_t rounded_up(std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; }

bool addresses_are_limited() {
  rlimit limit{};
  return getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY;
}

/// The whole pages among these bytes; none if the second number is 0.
std::pair<char*, std::size_t> whole_pages(char* start, std::size_t bytes) {
  static const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto address = reinterpret_cast<std::uintptr_t>(start);
  const std::uintptr_t first = rounded_up(address, page);
  const std::uintptr_t last = (address + bytes) / page * page;
  return {start + (first - address), first < last ? last - first : 0};
}

/// Whether the thread allocates for allocate_untouched, and its answer.
struct Untouching {
  bool wanted = false;
  bool fresh = false;
};
thread_local Untouching untouching;

/// One range of addresses, of which the part below `top_` may be used. So whatever is freed joins what is free next to it, and the next phase
/// of a search finds room in the pages of the phase before.
class Region {
 public:
  /// Two addresses, between which pages of a block are new or were given back.
  struct Fresh {
    char* first;
    char* last;
  };

  /// Reserves so many addresses, if they are to be had.
  explicit Region(std::size_t bytes) {
    void* const map = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (map == MAP_FAILED) return;
    start_ = top_ = touched_ = static_cast<char*>(map);
    end_ = start_ + bytes;
  }

  [[nodiscard]] bool has(const char* block) const { return start_ <= block && block < end_; }
  [[nodiscard]] std::size_t kept() const { return kept_; }

  /// Null if there is no room.
  char* allocate(std::size_t size, Fresh& fresh) {
    // The first that fits, because pages far below the top are rarely new. There are few free ranges.
    const auto fits = [size](const Ranges::value_type& free) { return free.second.bytes >= size; };
    auto fitting = std::ranges::find_if(free_, fits);
    if (fitting == free_.end()) {
      if (!grow(size)) return nullptr;
      fitting = std::prev(free_.end());
    }
    char* const start = fitting->first;
    const Free range = removed(fitting);
    if (range.bytes > size) insert(start + size, {range.bytes - size, range.kept - std::min(range.kept, size)});
    fresh = {range.kept == 0 ? start : std::max(start, touched_), start + size};
    touched_ = std::max(touched_, fresh.last);
    return start;
  }

  void deallocate(char* start, std::size_t size) { insert_joined(start, {size, size}); }

  /// Gives pages of free ranges back to the system, from the top down, until at most `most` bytes are kept.
  void keep(std::size_t most) {
    for (auto next = free_.end(); kept_ > most && next != free_.begin();) {
      auto& [start, range] = *--next;
      const auto [first, bytes] = whole_pages(start, range.bytes);
      if (range.kept > 0 && bytes > 0) madvise(first, bytes, MADV_DONTNEED);
      kept_ -= range.kept;
      range.kept = 0;
    }
  }

 private:
  struct Free {
    std::size_t bytes;
    std::size_t kept;  ///< bytes whose pages are kept, at most
  };
  using Ranges = std::map<char*, Free>;

  void insert(char* start, const Free& range) {
    free_.emplace(start, range);
    kept_ += range.kept;
  }

  Free removed(Ranges::iterator free) {
    const Free range = free->second;
    free_.erase(free);
    kept_ -= range.kept;
    return range;
  }

  /// Joins the range with free ranges before and after it.
  void insert_joined(char* start, Free range) {
    const auto join = [&](Ranges::iterator with) {
      const Free other = removed(with);
      range = {range.bytes + other.bytes, range.kept + other.kept};
    };
    const auto after = free_.find(start + range.bytes);
    if (after != free_.end()) join(after);
    auto before = free_.lower_bound(start);
    if (before != free_.begin() && (--before)->first + before->second.bytes == start) {
      start = before->first;
      join(before);
    }
    insert(start, range);
  }

  /// Makes room for so many bytes at the top. Returns false if there is none.
  bool grow(std::size_t bytes) {
    if (start_ == nullptr) return false;
    std::size_t there = 0;
    if (!free_.empty() && free_.rbegin()->first + free_.rbegin()->second.bytes == top_)
      there = free_.rbegin()->second.bytes;
    const std::size_t more = rounded_up(bytes - there, growth);
    if (more > static_cast<std::size_t>(end_ - top_) || mprotect(top_, more, PROT_READ | PROT_WRITE) != 0) return false;
    char* const old = top_;
    top_ += more;
    insert_joined(old, {more, 0});
    return true;
  }

  char* start_ = nullptr;    ///< null: nothing is reserved
  char* top_ = nullptr;      ///< bytes from here on can't be used yet
  char* touched_ = nullptr;  ///< no block has had bytes from here on
  char* end_ = nullptr;
  Ranges free_;
  std::size_t kept_ = 0;  ///< bytes of pages kept in free_
};

/// Regions, each as large as all before it.
class Regions {
 public:
  [[nodiscard]] Region* of(const char* block) {
    const auto found = std::ranges::find_if(regions_, [block](const Region& region) { return region.has(block); });
    return found == regions_.end() ? nullptr : &*found;
  }

  [[nodiscard]] std::size_t kept() const {
    std::size_t all = 0;
    for (const Region& region : regions_) all += region.kept();
    return all;
  }

  /// Null if there is no room.
  char* allocate(std::size_t size, Region::Fresh& fresh) {
    for (Region& region : regions_)
      if (char* const start = region.allocate(size, fresh)) return start;
    const std::size_t bytes = std::max(rounded_up(size, growth), next_bytes_);
    Region more(bytes);
    char* const start = more.allocate(size, fresh);
    if (start == nullptr) return nullptr;
    regions_.push_back(std::move(more));
    next_bytes_ += bytes;
    return start;
  }

  /// Gives pages of free ranges back to the system, the last first, until at most `most` bytes are kept.
  void keep(std::size_t most) {
    std::size_t all = kept();
    for (auto region = regions_.rbegin(); region != regions_.rend() && all > most; ++region) {
      const std::size_t others = all - region->kept();
      region->keep(most - std::min(most, others));
      all = others + region->kept();
    }
  }

 private:
  std::vector<Region> regions_;
  std::size_t next_bytes_ = std::size_t{1} << 28;
};

class PagePool final : public std::pmr::memory_resource {
 public:
  PagePool() {
    if (!from_heap_) keep_large_blocks();
  }

  [[nodiscard]] std::size_t kept() {
    const std::lock_guard lock(mutex_);
    return full_.kept() + sparse_.kept();
  }

  void release() {
    const std::lock_guard lock(mutex_);
    keep(0);
  }

 private:
  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    if (alignment > pool_alignment) throw std::bad_alloc();
    const std::size_t size = rounded_up(bytes, pool_alignment);
    untouching.fresh = false;
    if (bytes >= least_block && !from_heap_ && !memory_limit_is_set()) {
      Region::Fresh fresh{};
      char* start = nullptr;
      {
        const std::lock_guard lock(mutex_);
        start = (untouching.wanted ? sparse_ : full_).allocate(size, fresh);
      }
      if (start != nullptr) {
        untouching.fresh = fresh.first < fresh.last;
        if (untouching.fresh && !untouching.wanted)
          touch_pages(fresh.first, static_cast<std::size_t>(fresh.last - fresh.first));
        return start;
      }
    }
    return ::operator new (size, std::align_val_t{pool_alignment});
  }

  void do_deallocate(void* block, std::size_t bytes, std::size_t) override {
    if (bytes < least_block) return ::operator delete (block, std::align_val_t{pool_alignment});
    auto* const start = static_cast<char*>(block);
    const std::lock_guard lock(mutex_);
    Region* region = full_.of(start);
    if (region == nullptr) region = sparse_.of(start);
    if (region == nullptr) return ::operator delete (block, std::align_val_t{pool_alignment});
    region->deallocate(start, rounded_up(bytes, pool_alignment));
    keep(memory_limit_is_set() ? 0 : most_kept_bytes);
  }

  [[nodiscard]] bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }

  void keep(std::size_t most) {
    sparse_.keep(most - std::min(most, full_.kept()));
    full_.keep(most);
  }

  /// glibc maps large blocks anew each time, until one that was mapped is freed: then it keeps smaller ones. So this frees one, for
  /// results of searches.
  static void keep_large_blocks() {
    constexpr std::size_t most_kept_block = (std::size_t{1} << 25) - growth;
    void* volatile block = ::operator new(most_kept_block);
    ::operator delete(block);
  }

  const bool from_heap_ = on_heap || addresses_are_limited();
  std::mutex mutex_;
  Regions full_;
  Regions sparse_;  ///< for blocks that may stay unused in part
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

UntouchedBytes allocate_untouched(std::pmr::memory_resource& memory, std::size_t bytes) {
  untouching = {.wanted = true};
  struct End {
    ~End() { untouching.wanted = false; }
  } end;
  void* const start = memory.allocate(bytes, pool_alignment);
  return {start, untouching.fresh};
}

void touch_pages([[maybe_unused]] void* start, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_POPULATE_WRITE
  const auto [first, size] = whole_pages(static_cast<char*>(start), std::min(bytes, most_touched_at_once));
  if (size > 0) madvise(first, size, MADV_POPULATE_WRITE);
#endif
}

}  // namespace detp::sim
