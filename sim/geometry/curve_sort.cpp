#include "curve_sort.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stop_check.hpp"

namespace detp::sim::stream {
namespace {

constexpr const char* doing = "sorting along the curve";

/// For each 10-bit number: its bit i at place 3i. A table, because three sums of shifts for each disc took a tenth of the
/// time of building a tree.
constexpr auto spread_10_bits = [] {
  std::array<std::uint32_t, 1024> table{};
  for (std::uint32_t number = 0; number < table.size(); ++number)
    for (int bit = 0; bit < 10; ++bit) table[number] |= (number >> bit & 1) << 3 * bit;
  return table;
}();

/// Resolution of the curve. Discs are first sorted by the upper bits of their codes, all at once; then cell by cell.
struct Resolution {
  int bits;                                                           ///< of a code
  int first_bits;                                                     ///< bits by which discs are sorted first
  [[nodiscard]] double cells() const { return 1 << bits / 3; }        ///< cells along the longest side
  [[nodiscard]] int shift() const { return 32 + bits - first_bits; }  ///< from a CurvePlace to its first bits
  [[nodiscard]] std::size_t first_cells() const { return std::size_t{1} << first_bits; }
};

Resolution resolution_for(std::size_t discs) { return discs < 8192 ? Resolution{18, 9} : Resolution{30, 12}; }

/// The first part of the sort. Discs are processed in stretches in parallel. Stretches, not threads, decide the order.
class FirstCells {
 public:
  FirstCells(std::span<const Disc> discs, const Box& box, const Resolution& resolution, const std::stop_token& stop)
      : discs_(discs),
        box_(box),
        resolution_(resolution),
        stop_(stop),
        stretches_(discs.size() < (1U << 16) ? 1 : 8),
        starts_(stretches_ * resolution.first_cells()) {}

  /// Writes the places, sorted by their first bits. Returns where each of the first cells ends.
  std::vector<std::uint32_t> sort(std::span<CurvePlace> unsorted, std::span<CurvePlace> sorted) {
    for_each_stretch([&](std::size_t first, std::size_t last, std::uint32_t* counts, StopCheck& check) {
      make_places(first, last, unsorted, counts, check);
    });
    std::uint32_t next = 0;
    std::vector<std::uint32_t> ends(resolution_.first_cells());
    for (std::size_t cell = 0; cell < ends.size(); ++cell) {
      for (std::size_t i = 0; i < stretches_; ++i) next += std::exchange(starts_[i * ends.size() + cell], next);
      ends[cell] = next;
    }
    for_each_stretch([&](std::size_t first, std::size_t last, std::uint32_t* starts, StopCheck& check) {
      const int shift = resolution_.shift();
      for_each_checked(first, last, check,
                       [&](std::size_t i) { sorted[starts[unsorted[i] >> shift]++] = unsorted[i]; });
    });
    return ends;
  }

 private:
  template <class Visit>
  void for_each_stretch(const Visit& visit) {
    sim::parallel_for(std::size_t{0}, stretches_, [&](std::size_t i) {
      StopCheck check(stop_, doing);
      visit(discs_.size() * i / stretches_, discs_.size() * (i + 1) / stretches_,
            &starts_[i * resolution_.first_cells()], check);
      check.now();
    });
  }

  /// Writes the places of a stretch of discs, and counts them by first cell.
  void make_places(std::size_t first, std::size_t last, std::span<CurvePlace> places, std::uint32_t* counts,
                   StopCheck& check) const {
    const double side = box_.longest_side();
    // with a smaller side the scale might not be finite: then all discs are in one cell
    constexpr double least_side = 1e-290;
    const double scale = side > least_side ? resolution_.cells() / side : 0;
    const glm::dvec3 low = box_.low;
    const auto last_cell = static_cast<std::uint32_t>(resolution_.cells()) - 1;
    const auto cell = [=](double above) {
      return spread_10_bits[std::min(static_cast<std::uint32_t>(above * scale), last_cell)];
    };
    const int shift = resolution_.shift();
    for_each_checked(first, last, check, [&](std::size_t i) {
      const glm::dvec3 above = discs_[i].centre - low;
      const std::uint32_t code = cell(above.x) << 2 | cell(above.y) << 1 | cell(above.z);
      const CurvePlace place = static_cast<CurvePlace>(code) << 32 | i;
      places[i] = place;
      ++counts[place >> shift];
    });
  }

  std::span<const Disc> discs_;
  const Box& box_;
  const Resolution& resolution_;
  const std::stop_token& stop_;
  std::size_t stretches_;
  std::vector<std::uint32_t> starts_;  ///< index of the next word, for each stretch and each of the first cells
};

/// Sorts words that agree in all bits above `shift`. Runs of at most `unsorted` words that agree in more bits keep their order.
void sort_cell(std::span<CurvePlace> words, std::span<CurvePlace> room, int shift, std::size_t unsorted,
               StopCheck& check) {
  constexpr int bits = 6;
  constexpr std::size_t cells = 1U << bits;
  constexpr std::size_t few = 24;  // below this, inserting one by one is faster than counting
  if (words.size() <= unsorted || shift <= 32) return;
  if (words.size() <= few) {
    for (std::size_t i = 1; i < words.size(); ++i) {
      const CurvePlace word = words[i];
      std::size_t place = i;
      for (; place > 0 && words[place - 1] > word; --place) words[place] = words[place - 1];
      words[place] = word;
    }
    check.after(words.size());
    return;
  }
  const int below = std::max(shift - bits, 32);
  const auto cell = [below](CurvePlace word) { return word >> below & (cells - 1); };
  std::array<std::uint32_t, cells> ends{};
  for_each_checked(std::size_t{0}, words.size(), check, [&](std::size_t i) { ++ends[cell(words[i])]; });
  if (ends[cell(words.front())] == words.size()) return sort_cell(words, room, below, unsorted, check);
  std::uint32_t next = 0;
  for (std::uint32_t& end : ends) next += std::exchange(end, next);
  for_each_checked(std::size_t{0}, words.size(), check,
                   [&](std::size_t i) { room[ends[cell(words[i])]++] = words[i]; });
  std::copy_n(room.begin(), words.size(), words.begin());
  std::uint32_t first = 0;
  for (const std::uint32_t end : ends) {
    sort_cell(words.subspan(first, end - first), room, below, unsorted, check);
    first = end;
  }
}

}  // namespace

CurvePlaces sort_along_curve(std::span<const Disc> discs, const Box& centres, std::size_t unsorted,
                             const std::stop_token& stop) {
  const Resolution resolution = resolution_for(discs.size());
  CurvePlaces other(discs.size());
  CurvePlaces places(discs.size());
  const std::vector<std::uint32_t> ends = FirstCells(discs, centres, resolution, stop).sort(other, places);
  const std::span<CurvePlace> all(places);
  const std::span<CurvePlace> room(other);
  sim::parallel_for(ParallelRange(0, ends.size(), ends.size() / 64), [&](const auto& cells) {
    StopCheck check(stop, doing);
    for (std::size_t cell = cells.begin(); cell < cells.end(); ++cell) {
      const std::size_t first = cell == 0 ? 0 : ends[cell - 1];
      sort_cell(all.subspan(first, ends[cell] - first), room.subspan(first), resolution.shift(), unsorted, check);
    }
    check.now();
  });
  return places;
}

}  // namespace detp::sim::stream
