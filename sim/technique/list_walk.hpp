#pragma once

#include "detp/sim/geometry.hpp"

namespace detp::sim {

/// Nested spheres that follow the discs, one disc after another: which must be built anew, where each then is.
///
/// Level 0 is S₀, which holds all rays and is never built. Level i's list of rays is made from level i - 1's.
class ListWalk {
 public:
  virtual ~ListWalk() = default;

  /// Goes on to the next disc. Levels from the returned one to innermost() must be built anew, none if it is larger.
  virtual int enter(const Disc& disc) = 0;

  /// The level whose list the disc is tested against.
  [[nodiscard]] virtual int innermost() const = 0;

  /// The largest level that there can be.
  [[nodiscard]] virtual int deepest() const = 0;

  /// Where a level stands; only of 1 … innermost().
  [[nodiscard]] virtual const Sphere& sphere(int level) const = 0;
};

}  // namespace detp::sim
