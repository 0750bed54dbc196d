#include "frame.hpp"

#include <cmath>

namespace detp::sim::stream {

Frame::Frame(const Problem& problem)
    : centre(problem.enclosing().centre), scale(std::ldexp(1.0, -(std::ilogb(problem.enclosing().radius) + 1))) {
  slack = problem.slack() * scale;
  margin = static_cast<float>(64 * float_unit + 2 * slack);
}

FloatSphere Frame::operator()(const Sphere& sphere) const {
  const glm::dvec3 c = (*this)(sphere.centre);
  return {{static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)},
          static_cast<float>(sphere.radius * scale) + margin};
}

}  // namespace detp::sim::stream
