#include "curve_sort.hpp"

#include <algorithm>
#include <utility>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stop_check.hpp"

namespace detp::sim::stream {
namespace {

constexpr const char* doing = "sorting along the curve";

/// Moves bit i of a 10-bit number to bit 3i.
std::uint32_t spread_10_bits(std::uint32_t bits) {
  bits = (bits | bits << 16) & 0x0300'00ff;
  bits = (bits | bits << 8) & 0x0300'f00f;
  bits = (bits | bits << 4) & 0x030c'30c3;
  bits = (bits | bits << 2) & 0x0924'9249;
  return bits;
}

/// Resolution of the curve.
struct Resolution {
  int digits;                                                                  ///< digits in a code
  int digit_bits;                                                              ///< bits in a digit
  [[nodiscard]] double cells() const { return 1 << digits * digit_bits / 3; }  ///< cells along the longest side
  [[nodiscard]] std::uint32_t digit(CurvePlace place, int number) const {
    return place_code(place) >> (digit_bits * number) & ((1U << digit_bits) - 1);
  }
};

Resolution resolution_for(std::size_t discs) { return discs < 8192 ? Resolution{2, 9} : Resolution{3, 10}; }

std::vector<CurvePlace> places_of(std::span<const Disc> discs, const Box& box, double cells,
                                  const std::stop_token& stop) {
  const double side = box.longest_side();
  // with a smaller side the scale might not be finite: then all discs are in one cell
  constexpr double least_side = 1e-290;
  const double scale = side > least_side ? cells / side : 0;
  const auto last = static_cast<std::uint32_t>(cells) - 1;
  const auto cell = [&](double above) {
    return spread_10_bits(std::min(static_cast<std::uint32_t>(above * scale), last));
  };
  std::vector<CurvePlace> places(discs.size());
  sim::parallel_for(ParallelRange(0, discs.size(), 1U << 14), [&](const auto& range) {
    StopCheck check(stop, doing);
    for_each_checked(range.begin(), range.end(), check, [&](std::size_t i) {
      const glm::dvec3 above = discs[i].centre - box.low;
      const std::uint32_t code = cell(above.x) << 2 | cell(above.y) << 1 | cell(above.z);
      places[i] = static_cast<CurvePlace>(code) << 32 | i;
    });
    check.now();
  });
  return places;
}

/// One pass of a radix sort. Processes stretches of the words in parallel.
class Pass {
 public:
  Pass(const Resolution& resolution, int digit, std::span<const CurvePlace> from, const std::stop_token& stop)
      : resolution_(resolution),
        digit_(digit),
        from_(from),
        stop_(stop),
        stretches_(from.size() < (1U << 16) ? 1 : 8) {}

  void move_to(std::span<CurvePlace> to) {
    const std::size_t values = std::size_t{1} << resolution_.digit_bits;
    starts_.assign(stretches_ * values, 0);
    for_each_word([&](std::size_t i, CurvePlace word) { ++starts_[i * values + resolution_.digit(word, digit_)]; });
    std::uint32_t next = 0;
    for (std::size_t value = 0; value < values; ++value)
      for (std::size_t i = 0; i < stretches_; ++i) next += std::exchange(starts_[i * values + value], next);
    for_each_word(
        [&](std::size_t i, CurvePlace word) { to[starts_[i * values + resolution_.digit(word, digit_)]++] = word; });
  }

 private:
  template <class Visit>
  void for_each_word(const Visit& visit) const {
    sim::parallel_for(std::size_t{0}, stretches_, [&](std::size_t i) {
      StopCheck check(stop_, doing);
      for_each_checked(from_.size() * i / stretches_, from_.size() * (i + 1) / stretches_, check,
                       [&](std::size_t word) { visit(i, from_[word]); });
      check.now();
    });
  }

  const Resolution& resolution_;
  int digit_;
  std::span<const CurvePlace> from_;
  const std::stop_token& stop_;
  std::size_t stretches_;
  std::vector<std::uint32_t> starts_;  ///< index of the next word, for each stretch and each value of the digit
};

}  // namespace

std::vector<CurvePlace> sort_along_curve(std::span<const Disc> discs, const Box& centres, const std::stop_token& stop) {
  const Resolution resolution = resolution_for(discs.size());
  std::vector<CurvePlace> places = places_of(discs, centres, resolution.cells(), stop);
  std::vector<CurvePlace> other(places.size());
  for (int digit = 0; digit < resolution.digits; ++digit) {
    Pass(resolution, digit, places, stop).move_to(other);
    places.swap(other);
  }
  return places;
}

}  // namespace detp::sim::stream
