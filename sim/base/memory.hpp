#pragma once

#include <cstddef>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace detp::sim {

/// Bytes that this process may have: the machine's memory, or less where a cgroup (version 1 or 2), RLIMIT_AS or
/// RLIMIT_DATA allows less. Read once.
[[nodiscard]] double machine_memory();

/// Bytes that one piece of work may take, its rays and discs included: what set_memory_limit or the environment
/// variable DETP_MEMORY_LIMIT says, else half of machine_memory. Throws std::invalid_argument where the variable is
/// malformed.
[[nodiscard]] double memory_budget();

/// Sets the budget, for all threads of the process; nothing restores the default. Throws std::invalid_argument unless
/// bytes > 0 and finite.
void set_memory_limit(std::optional<double> bytes);

/// Reads "4G", "512M" or a number of bytes: K, M, G and T are powers of 1024. Throws std::invalid_argument for anything
/// else.
[[nodiscard]] double parse_bytes(std::string_view text);

/// Throws std::length_error, naming the bytes, where `bytes` is more than the budget.
void require_memory(std::string_view what, double bytes);

/// Bytes that an array takes at its peak which has grown, by doubling, to `count` elements: while it is copied, the old
/// one is there too.
[[nodiscard]] double grown_bytes(std::size_t count, std::size_t element);

/// The least limit of the memory cgroups in a text as of /proc/self/cgroup, with the files under `root`
/// (/sys/fs/cgroup): of the process's own group and of those around it. Infinite where there is none.
[[nodiscard]] double cgroup_limit(const std::string& own_groups, const std::string& root);

/// Memory that was not to be had, and what for.
class OutOfMemory : public std::bad_alloc {
 public:
  explicit OutOfMemory(std::string_view doing);
  [[nodiscard]] const char* what() const noexcept override { return message_; }

 private:
  char message_[160];  // takes no memory
};

/// Calls `work`; if memory runs out in it, says what for: throws OutOfMemory("reading the scene").
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
