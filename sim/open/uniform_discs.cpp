#include "uniform_discs.hpp"

#include <fmt/format.h>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/scene/built_in/built_in.hpp"

namespace detp::sim {

std::vector<Disc> uniform_discs(Body body, double side, std::size_t count, double radius, std::uint64_t seed,
                                const std::stop_token& stop) {
  const DefaultFloatingPoint mode;
  require_positive("cube side", side);
  require_positive("disc radius", radius);
  require_memory(fmt::format("{} discs", count), static_cast<double>(count) * sizeof(Disc));
  StopCheck check(stop, "making discs");
  std::vector<Disc> discs;
  discs.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    check.after(1);
    const Sample sample = built_in::uniform_sample(i, seed);
    glm::dvec3 position = sample.position;
    if (body == Body::cube_faces) {
      const int face = static_cast<int>(6 * uniform4(seed, Stream::samples, i, 2)[0]);
      position[face / 2] = face % 2 == 0 ? -1 : 1;
    }
    discs.push_back({.centre = 0.5 * side * position, .normal = sample.normal, .radius = radius});
  }
  return discs;
}

}  // namespace detp::sim
