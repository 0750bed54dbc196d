#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "ranks.hpp"

/// Arrays whose parts the ranks fill.
namespace detp::sim {

/// The part of this rank, or of another: elements first … last - 1 of `count`. Parts follow one another in the order of the ranks.
[[nodiscard]] inline std::pair<std::size_t, std::size_t> part_of(std::size_t count, const Ranks& ranks, int rank) {
  const auto number = static_cast<std::size_t>(rank);
  const auto all = static_cast<std::size_t>(ranks.count());
  const auto start = [&](std::size_t i) { return count / all * i + count % all * i / all; };
  return {start(number), start(number + 1)};
}
[[nodiscard]] inline std::pair<std::size_t, std::size_t> part_of(std::size_t count, const Ranks& ranks) {
  return part_of(count, ranks, ranks.rank());
}

/// Each rank has filled its part of an array that is as long on all ranks. Fills in the other parts.
template <class T>
void share_parts(Ranks& ranks, std::span<T> array) {
  const auto part = [&](int rank) {
    const auto [first, last] = part_of(array.size(), ranks, rank);
    return array.subspan(first, last - first);
  };
  if (ranks.rank() != 0) {
    ranks.send_all(std::span<const T>(part(ranks.rank())), 0);
    ranks.receive_all(array, 0);
    return;
  }
  for (int from = 1; from < ranks.count(); ++from) ranks.receive_all(part(from), from);
  for (int to = 1; to < ranks.count(); ++to) ranks.send_all(std::span<const T>(array), to);
}

/// The largest of the ranks' values, on all ranks.
template <class T>
[[nodiscard]] T largest(Ranks& ranks, const T& own) {
  std::vector<T> all(static_cast<std::size_t>(ranks.count()));
  all[static_cast<std::size_t>(ranks.rank())] = own;
  share_parts(ranks, std::span(all));
  return *std::ranges::max_element(all);
}

}  // namespace detp::sim
