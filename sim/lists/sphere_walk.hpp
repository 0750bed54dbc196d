#pragma once

#include <vector>

#include "detp/sim/search/problem.hpp"
#include "list_walk.hpp"

namespace detp::sim {

/// The sphere cache's spheres S₁ … S_k. S_i has the radius r₀Qⁱ (r₀ the radius of S₀, Q = parameters.ratio) and the
/// centre of the disc for which it was built.
///
/// For each disc, the spheres that serve it (ServingSpheres) are kept. All smaller spheres that are at least as large
/// as the disc are rebuilt around it.
class SphereWalk : public ListWalk {
 public:
  /// Which spheres serve a disc.
  enum class ServingSpheres {
    all_that_hold,  ///< from the outermost inwards, until a sphere does not contain the disc: exact
    /// the paper's rule (section 2.2): the innermost sphere that contains the disc serves it. So do all larger spheres,
    /// even those that do not contain the disc, so lists may lack rays
    innermost_that_holds
  };

  /// Omits spheres smaller than the smallest disc, which would never be built.
  SphereWalk(const Problem& problem, const SphereCacheParameters& parameters, ServingSpheres serving);

  /// A copy that allocates from `memory`.
  SphereWalk(const SphereWalk& other, std::pmr::memory_resource& memory)
      : serving_(other.serving_), spheres_(other.spheres_, &memory), built_(other.built_) {}

  /// The number of spheres without S₀, or one more. Check the spheres' memory before making them: for Q = 1 - 1e-9 and
  /// a smallest disc radius r there are about 10⁹·ln(r₀/r), unless parameters.spheres is less.
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
