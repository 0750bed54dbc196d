#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "mesh.hpp"
#include "plate.hpp"
#include "scaling.hpp"

namespace detp::sim {

/// The triangles of a mesh in the order in which they win where they coincide, scaled by a power of two.
struct Plates {
  std::vector<Plate> all = {};               ///< higher than the slack, without the repeated ones; the winners first
  std::vector<std::uint32_t> repeated = {};  ///< triangles with the same corners and face as an earlier one, which wins
  std::uint64_t emitting_repeated = 0;       ///< of them
  double slack = 0;                          ///< lengths up to this are 0
  Scaling scaled = Scaling{};                ///< the power of two
};

/// Throws Stopped if a stop was requested.
[[nodiscard]] Plates plates_of(const Mesh& mesh, const std::stop_token& stop);

}  // namespace detp::sim
