#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "list_walk.hpp"

/// The octree cells of the samples, visited along the Morton curve (the paper: Lebesgue curve), and spheres around
/// them.
namespace detp::sim {

/// The first i octal digits of a sample's Morton code select its cell of level i, of side s_i; level 0 is the samples'
/// cube. The cell's sphere has the cell's centre and the radius s_i √3/2 + d, where d is the largest disc radius. It
/// contains the discs of all samples in the cell, and lies in the parent cell's sphere (proof:
/// model/hierarchy/cell_spheres.hpp).
///
/// Rounding may give a sample the code of an adjacent cell. The sample then lies within 3 ulp (of the cube's size and
/// position) of that cell. The culls' slack is thousands of times larger.
class CellWalk : public ListWalk {
 public:
  /// For levels 0 … depth.
  CellWalk(std::span<const Disc> discs, int depth);

  /// A copy that allocates from `memory`.
  CellWalk(const CellWalk& other, std::pmr::memory_resource& memory)
      : box_(other.box_),
        side_(other.side_),
        code_(other.code_),
        entered_(other.entered_),
        spheres_(other.spheres_, &memory) {}

  /// Advances to the next disc. Returns the first level, at least 1, at which this disc's cell differs from the
  /// previous disc's cell; depth + 1 if no cell differs; 1 for the first disc.
  int enter(const Disc& disc) override;
  [[nodiscard]] int innermost() const override { return deepest(); }
  [[nodiscard]] int deepest() const override { return static_cast<int>(spheres_.size()) - 1; }

  /// The sphere of the current disc's cell at that level.
  [[nodiscard]] const Sphere& sphere(int level) const override { return spheres_[static_cast<std::size_t>(level)]; }

 private:
  Box box_;
  double side_ = 0;
  std::uint64_t code_ = 0;
  bool entered_ = false;
  std::pmr::vector<Sphere> spheres_;
};

}  // namespace detp::sim
