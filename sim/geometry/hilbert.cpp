#include "hilbert.hpp"

#include "curve.hpp"

namespace detp::sim {
namespace {

constexpr unsigned rotated_left(unsigned bits, unsigned by) { return (bits << by | bits >> (3 - by)) & 7; }
constexpr unsigned rotated_right(unsigned bits, unsigned by) { return rotated_left(bits, (3 - by) % 3); }
constexpr unsigned gray(unsigned number) { return number ^ number >> 1; }
constexpr unsigned number_of_gray(unsigned code) { return code ^ code >> 1 ^ code >> 2; }
constexpr unsigned start(unsigned visit) { return visit == 0 ? 0 : gray((visit - 1) / 2 * 2); }

constexpr unsigned turn(unsigned visit) {
  if (visit == 0) return 0;
  unsigned ones = 0;
  for (unsigned bits = visit % 2 == 0 ? visit - 1 : visit; bits & 1; bits >>= 1) ++ones;
  return ones % 3;
}

/// One octal digit of the code, and the state inside that octant.
struct Step {
  std::uint8_t digit;
  std::uint8_t state;  ///< 3 corner + axis
};

constexpr auto make_steps() {
  std::array<std::array<Step, 8>, 24> steps{};
  for (unsigned corner = 0; corner < 8; ++corner)
    for (unsigned axis = 0; axis < 3; ++axis)
      for (unsigned octant = 0; octant < 8; ++octant) {
        const unsigned by = (axis + 1) % 3;
        const unsigned visit = number_of_gray(rotated_right(octant ^ corner, by));
        const unsigned next_corner = corner ^ rotated_left(start(visit), by);
        const unsigned next_axis = (axis + 1 + turn(visit)) % 3;
        steps[3 * corner + axis][octant] = {static_cast<std::uint8_t>(visit),
                                            static_cast<std::uint8_t>(3 * next_corner + next_axis)};
      }
  return steps;
}

constexpr auto steps = make_steps();

}  // namespace

std::uint64_t hilbert_code(const glm::dvec3& point, const Box& box) {
  const CurveCell cell = curve_cell(point, box);
  std::uint64_t code = 0;
  unsigned state = 0;
  for (int level = 15; level >= 0; --level) {
    const unsigned octant = (cell[0] >> level & 1) << 2 | (cell[1] >> level & 1) << 1 | (cell[2] >> level & 1);
    const Step step = steps[state][octant];
    code = code << 3 | step.digit;
    state = step.state;
  }
  return code;
}

std::vector<std::uint32_t> hilbert_order(std::span<const glm::dvec3> points, const std::stop_token& stop) {
  return order_along(points, hilbert_code, stop);
}

}  // namespace detp::sim
