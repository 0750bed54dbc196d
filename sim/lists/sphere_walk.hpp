#pragma once

#include <vector>

#include "detp/sim/search/problem.hpp"
#include "list_walk.hpp"

namespace detp::sim {

/// The sphere cache's spheres S₁ … S_k. S_i has the radius r₀Qⁱ and the centre of the disc for which it was built.
///
/// The first sphere that does not serve a disc, and all smaller spheres that can hold it, are rebuilt around the disc.
class SphereWalk : public ListWalk {
 public:
  /// Which spheres serve a disc.
  enum class ServingSpheres {
    all_that_hold,  ///< from the outermost inwards, until a sphere does not contain the disc: exact
    /// the paper's rule (section 2.2): the innermost sphere that contains the disc and all larger spheres, even if one
    /// of these does not contain the disc; lists may lack rays
    innermost_that_holds
  };

  /// Omits spheres smaller than the smallest disc, which would never be built.
  SphereWalk(const Problem& problem, const SphereCacheParameters& parameters, ServingSpheres serving);

  /// A copy that allocates from `memory`.
  SphereWalk(const SphereWalk& other, std::pmr::memory_resource& memory)
      : serving_(other.serving_), spheres_(other.spheres_, &memory), built_(other.built_) {}

  /// The number of spheres without S₀, or one more. For Q = 1 - 1e-9 about 10⁹·ln(r₀/r), so check their memory first.
  [[nodiscard]] static double levels(const Problem& problem, const SphereCacheParameters& parameters);

  int enter(const Disc& disc) override;
  [[nodiscard]] int innermost() const override { return built_ - 1; }
  [[nodiscard]] int deepest() const override { return static_cast<int>(spheres_.size()) - 1; }
  [[nodiscard]] const Sphere& sphere(int level) const override { return spheres_[static_cast<std::size_t>(level)]; }

 private:
  [[nodiscard]] int serving_level(const Disc& disc) const;

  ServingSpheres serving_;
  std::pmr::vector<Sphere> spheres_;
  int built_ = 1;  ///< number of spheres that are built, with S₀
};

}  // namespace detp::sim
