#include "frame.hpp"

#include <cmath>

namespace detp::sim::stream {

Frame::Frame(const Problem& problem)
    : centre(problem.enclosing.centre), scale(std::ldexp(1.0, -(std::ilogb(problem.enclosing.radius) + 1))) {
  slack = problem.slack * scale;
  margin = static_cast<float>(32 * float_unit + 2 * slack);
}

}  // namespace detp::sim::stream
