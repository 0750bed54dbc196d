#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "stop_check.hpp"

namespace detp::sim {

/// An index with the key that it is sorted by, such as its place on a curve.
struct KeyedIndex {
  std::uint64_t key;
  std::uint32_t index;
};

/// Sorts the entries stably into `to`, by the 8-bit digit that starts at bit `shift`, and returns true. If all entries
/// have the same digit, returns false and does not write to `to`. Throws Stopped if a stop was requested.
inline bool sort_by_digit(const std::vector<KeyedIndex>& from, std::vector<KeyedIndex>& to, int shift,
                          StopCheck& check) {
  std::array<std::size_t, 256> place{};
  const auto digit = [shift](const KeyedIndex& entry) { return (entry.key >> shift) & 0xff; };
  for_each_checked(std::span(from), check, [&](const KeyedIndex& entry) { ++place[digit(entry)]; });
  if (place[digit(from.front())] == from.size()) return false;
  std::size_t next = 0;
  for (std::size_t& start : place) next += std::exchange(start, next);
  for_each_checked(std::span(from), check, [&](const KeyedIndex& entry) { to[place[digit(entry)]++] = entry; });
  return true;
}

/// Stable sort by rising key. Keys have at most `bits` bits. Cost O(n): for each 8-bit digit one pass that counts
/// entries, and one that moves them (unless all have the same digit). Throws Stopped if a stop was requested; the
/// entries are then in any order.
inline void radix_sort(std::vector<KeyedIndex>& entries, int bits = 64, const std::stop_token& stop = {}) {
  if (entries.empty()) return;
  StopCheck check(stop, "sorting along a curve");
  std::vector<KeyedIndex> other(entries.size());
  for (int shift = 0; shift < bits; shift += 8)
    if (sort_by_digit(entries, other, shift, check)) entries.swap(other);
}

}  // namespace detp::sim
