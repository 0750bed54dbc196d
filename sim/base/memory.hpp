#pragma once

#include <cstddef>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace detp::sim {

/// Bytes that this process may use: the machine's memory, or less if a cgroup (version 1 or 2), RLIMIT_AS or
/// RLIMIT_DATA sets a smaller limit. Read once.
[[nodiscard]] double machine_memory();

/// Bytes that one piece of work may use, including its rays and discs: the limit of set_memory_limit, else of the
/// environment variable DETP_MEMORY_LIMIT, else half of machine_memory. Throws std::invalid_argument if the variable is
/// malformed.
[[nodiscard]] double memory_budget();

/// Sets the budget for all threads of the process; without a value, restores the default. Throws std::invalid_argument
/// unless the value is > 0 and finite.
void set_memory_limit(std::optional<double> bytes);

/// Whether the limit is one of set_memory_limit or of the environment variable.
[[nodiscard]] bool memory_limit_is_set();

/// Reads a size > 0: "4G", "512M" or a number of bytes. K, M, G and T are powers of 1024. Throws std::invalid_argument
/// for any other text.
[[nodiscard]] double parse_bytes(std::string_view text);

/// Throws std::length_error if `bytes` exceeds the budget. The message names `what` and the bytes.
void require_memory(std::string_view what, double bytes);

/// Peak bytes, counted in used pages, of an array that grows by doubling to `count` elements of `element` bytes. At the
/// peak, the elements are copied and the old array still exists.
[[nodiscard]] double grown_bytes(std::size_t count, std::size_t element);

/// Returns to the system what was freed, but is kept by the C library for later; takes some milliseconds. Does nothing unless that is glibc.
void return_freed_memory();

/// The smallest limit of the process's own memory cgroup and of the groups around it; infinite if no limit is set.
/// `own_groups` is text in the format of /proc/self/cgroup; the groups' files are under `root` (/sys/fs/cgroup).
[[nodiscard]] double cgroup_limit(const std::string& own_groups, const std::string& root);

/// Memory ran out. The message names the work that needed it.
class OutOfMemory : public std::bad_alloc {
 public:
  explicit OutOfMemory(std::string_view doing);
  [[nodiscard]] const char* what() const noexcept override { return message_; }

 private:
  char message_[160];  // allocates no memory
};

/// Calls `work`. If memory runs out in it, throws OutOfMemory, whose message names the work: `doing`, such as "reading
/// the scene".
template <class Work>
auto in_memory(std::string_view doing, Work&& work) -> decltype(work()) {
  try {
    return std::forward<Work>(work)();
  } catch (const OutOfMemory&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw OutOfMemory(doing);
  }
}

}  // namespace detp::sim
