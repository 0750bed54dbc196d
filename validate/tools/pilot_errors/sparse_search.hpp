#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "detp/sim/scene/scene.hpp"

namespace detp::study {

/// A search of a scene with dense objects that few rays reach. All of it follows from the seed.
struct SparseSearch {
  std::uint64_t seed;
  std::string_view kind;  ///< "tiny object", "furnished room" or "clusters"
  std::string mesh;       ///< as an OBJ file
  sim::Field field;
  double rays;    ///< 20 000 to 200 000
  double radius;  ///< of the discs, as a share of the scene's longest side: 0.2 to 3.5 %
};

[[nodiscard]] SparseSearch sparse_search(std::uint64_t seed);

}  // namespace detp::study
