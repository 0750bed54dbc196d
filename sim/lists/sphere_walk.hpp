#pragma once

#include <vector>

#include "detp/sim/search/problem.hpp"
#include "list_walk.hpp"

namespace detp::sim {

/// The sphere cache's spheres S₁ … S_k, of radius r₀Qⁱ, around the discs for which they were built.
///
/// From the first sphere that does not serve the disc, all are rebuilt around its centre, as long as they contain it.
class SphereWalk : public ListWalk {
 public:
  /// Which spheres serve a disc.
  enum class ServingSpheres {
    all_that_hold,  ///< those that contain it, from the outermost inwards without a gap: exact
    /// the paper's rule (section 2.2): the innermost that contains it, even if a larger one does not; its list may lack
    /// rays
    innermost_that_holds
  };

  /// Omits spheres smaller than the smallest disc, which would never be built.
  SphereWalk(const Problem& problem, const SphereCacheParameters& parameters, ServingSpheres serving);

  /// A copy in that memory.
  SphereWalk(const SphereWalk& other, std::pmr::memory_resource& memory)
      : serving_(other.serving_), spheres_(other.spheres_, &memory), built_(other.built_) {}

  /// The number of these spheres. For Q = 1 - 1e-9 it can reach about 10⁹·ln(r₀/r), so check their memory first.
  [[nodiscard]] static double levels(const Problem& problem, const SphereCacheParameters& parameters);

  int enter(const Disc& disc) override;
  [[nodiscard]] int innermost() const override { return built_ - 1; }
  [[nodiscard]] int deepest() const override { return static_cast<int>(spheres_.size()) - 1; }
  [[nodiscard]] const Sphere& sphere(int level) const override { return spheres_[static_cast<std::size_t>(level)]; }

 private:
  [[nodiscard]] int serving_level(const Disc& disc) const;

  ServingSpheres serving_;
  std::pmr::vector<Sphere> spheres_;
  int built_ = 1;  ///< S₀ … S_built-1 are where they were last built
};

}  // namespace detp::sim
