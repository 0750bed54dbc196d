#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace detp::sim {

/// Something to sort: by a key, such as its place on a curve.
struct KeyedIndex {
  std::uint64_t key;
  std::uint32_t index;
};

/// Stable sort by the digit of 8 bits at `shift`; false where all digits are equal and nothing was done.
inline bool sort_by_digit(const std::vector<KeyedIndex>& from, std::vector<KeyedIndex>& to, int shift) {
  std::array<std::size_t, 256> place{};
  const auto digit = [shift](const KeyedIndex& entry) { return (entry.key >> shift) & 0xff; };
  for (const KeyedIndex& entry : from) ++place[digit(entry)];
  if (place[digit(from.front())] == from.size()) return false;
  std::size_t next = 0;
  for (std::size_t& start : place) next += std::exchange(start, next);
  for (const KeyedIndex& entry : from) to[place[digit(entry)]++] = entry;
  return true;
}

/// Sorts by rising key; entries of the same key keep their order. Keys have at most `bits` bits. Cost O(n): a pass to
/// count each digit of 8 bits, and one to move for each that is not the same throughout.
inline void radix_sort(std::vector<KeyedIndex>& entries, int bits = 64) {
  if (entries.empty()) return;
  std::vector<KeyedIndex> other(entries.size());
  for (int shift = 0; shift < bits; shift += 8)
    if (sort_by_digit(entries, other, shift)) entries.swap(other);
}

}  // namespace detp::sim
