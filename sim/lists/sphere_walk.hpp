#pragma once

#include <vector>

#include "detp/sim/search/problem.hpp"
#include "list_walk.hpp"

namespace detp::sim {

/// The sphere cache's spheres S₁ … S_k, of radius r₀Qⁱ, around the discs for which they were built.
///
/// From the first that does not serve the disc, all are built anew around its centre, as long as they hold it.
class SphereWalk : public ListWalk {
 public:
  /// Which spheres serve a disc.
  enum class Serving {
    all_that_hold,        ///< those that hold it, from the outermost inwards without a gap: exact
    innermost_that_holds  ///< the paper's (section 2.2): whether or not those around it do; its list may lack rays
  };

  /// Spheres smaller than the smallest disc, which would never be built, are left out.
  SphereWalk(const Problem& problem, const SphereCacheParameters& parameters, Serving serving);

  /// How many spheres those are. At most about 10⁹·ln(r₀/r) where Q = 1 - 1e-9: their memory is worth a check first.
  [[nodiscard]] static double levels(const Problem& problem, const SphereCacheParameters& parameters);

  int enter(const Disc& disc) override;
  [[nodiscard]] int innermost() const override { return built_ - 1; }
  [[nodiscard]] int deepest() const override { return static_cast<int>(spheres_.size()) - 1; }
  [[nodiscard]] const Sphere& sphere(int level) const override { return spheres_[static_cast<std::size_t>(level)]; }

 private:
  [[nodiscard]] int serving(const Disc& disc) const;

  Serving serving_;
  std::vector<Sphere> spheres_;
  int built_ = 1;  ///< S₀ … S_built-1 are where they were last built
};

}  // namespace detp::sim
