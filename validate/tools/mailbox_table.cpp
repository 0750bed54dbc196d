// Makes model/disc_index/index_mailbox_table.inc: the share of lines that meet the cells that a disc overlaps.
//
//   cmake --build build --target mailbox_table && build/mailbox_table > model/disc_index/index_mailbox_table.inc
//
// Places discs of radius x uniformly and isotropically in an endless grid of cells of side 1, and draws lines through a
// sphere around all cells that a disc overlaps. S(x) is the share of the lines that meet one of these cells, times the
// area of the sphere. Prints R(x) = (S(x) - 6 - 2πx²)/x for x = 2⁻⁴, 2⁻³·⁵, … 2⁵. Takes about five minutes.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/disc_box.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/geometry/ray_box.hpp"
#include "detp/sim/rays/line_field.hpp"

namespace {

using namespace detp::sim;
using std::numbers::pi;

constexpr std::uint64_t seed = 20261121;
constexpr std::size_t lines_per_disc = 256;

Disc random_disc(double radius, std::size_t number) {
  const auto place = uniform4(seed, Stream::tests, number);
  const auto turn = uniform4(seed, Stream::tests, number, 1);
  return {{place[0], place[1], place[2]}, uniform_direction(turn[0], turn[1]), radius};
}

std::vector<Box> cells_of(const Disc& disc) {
  const Box reach = bounds(disc, 0);
  const glm::dvec3 low = glm::floor(reach.low);
  std::vector<Box> cells;
  for (double z = low.z; z <= reach.high.z; ++z)
    for (double y = low.y; y <= reach.high.y; ++y)
      for (double x = low.x; x <= reach.high.x; ++x)
        if (const Box cell{{x, y, z}, {x + 1, y + 1, z + 1}}; overlaps(disc, cell, 0)) cells.push_back(cell);
  return cells;
}

double measure_of_lines(double radius, std::size_t discs) {
  double met = 0;
  const double reach = radius + std::sqrt(3.0);
  for (std::size_t number = 0; number < discs; ++number) {
    const Disc disc = random_disc(radius, number);
    const std::vector<Box> cells = cells_of(disc);
    const LineField field({disc.centre, reach}, seed);
    for (std::size_t i = 0; i < lines_per_disc; ++i) {
      const ClippedRay line(field.line(number * lines_per_disc + i));
      met += std::any_of(cells.begin(), cells.end(), [&](const Box& cell) { return !line.inside(cell).empty(); });
    }
  }
  return 4 * pi * reach * reach * met / static_cast<double>(discs * lines_per_disc);
}

}  // namespace

int main() {
  fmt::print("// Made by validate/tools/mailbox_table.cpp.\n");
  for (int half = -8; half <= 10; ++half) {
    const double x = std::exp2(0.5 * half);
    const std::size_t discs = x < 1 ? 200'000 : static_cast<std::size_t>(40'000 / x);
    fmt::print("{:.3f},{}", (measure_of_lines(x, discs) - 6 - 2 * pi * x * x) / x, half == 10 ? "\n" : " ");
  }
}
