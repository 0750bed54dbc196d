#pragma once

#include <functional>
#include <memory_resource>

#include "detp/sim/base/scratch.hpp"
#include "detp/sim/geometry/geometry.hpp"

namespace detp::sim {

/// Nested spheres that follow the discs, one disc after another. Decides which spheres must be rebuilt, and where.
///
/// Level 0 is S₀. Its list holds all rays and is never rebuilt. Level i's list is culled from the list of level i - 1.
class ListWalk {
 public:
  virtual ~ListWalk() = default;

  /// Advances to the next disc. The caller must rebuild levels [result, innermost()]; the range is empty if result >
  /// innermost().
  virtual int enter(const Disc& disc) = 0;

  /// The level whose list the disc is tested against.
  [[nodiscard]] virtual int innermost() const = 0;

  /// The largest possible level.
  [[nodiscard]] virtual int deepest() const = 0;

  /// The sphere of a level; only for 1 … innermost().
  [[nodiscard]] virtual const Sphere& sphere(int level) const = 0;
};

/// Makes, in the given memory, a walk that has not met a disc yet.
using MakeWalk = std::function<OwnedIn<ListWalk>(std::pmr::memory_resource&)>;

}  // namespace detp::sim
