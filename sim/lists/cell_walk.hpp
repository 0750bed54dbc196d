#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "list_walk.hpp"

/// The octree cells of the samples, visited along the Morton curve (the paper: Lebesgue curve), and spheres around
/// them.
namespace detp::sim {

/// The cell of level i (0: the samples' cube) is that of the first i octal digits of the sample's Morton code. Its
/// sphere has the cell's centre and the radius s_i √3/2 + d. It contains the discs of all samples in the cell, and lies
/// in the sphere of the cell around it (proof: model/hierarchy/cell_spheres.hpp).
///
/// This also holds with rounding: a sample's code may be that of the adjacent cell, but then the sample lies within 3
/// ulp (of the cube's size and place) of that cell, and the culls' slack is thousands of times larger.
class CellWalk : public ListWalk {
 public:
  /// For levels 0 … depth.
  CellWalk(std::span<const Disc> discs, int depth);

  /// A copy in that memory.
  CellWalk(const CellWalk& other, std::pmr::memory_resource& memory)
      : box_(other.box_),
        side_(other.side_),
        code_(other.code_),
        entered_(other.entered_),
        spheres_(other.spheres_, &memory) {}

  /// Advances to the cells of the next disc. Returns the first level, at least 1, at which they differ from those of
  /// the disc before; depth + 1 if all are equal.
  int enter(const Disc& disc) override;
  [[nodiscard]] int innermost() const override { return deepest(); }
  [[nodiscard]] int deepest() const override { return static_cast<int>(spheres_.size()) - 1; }

  /// The sphere of the cell of that level around the current disc.
  [[nodiscard]] const Sphere& sphere(int level) const override { return spheres_[static_cast<std::size_t>(level)]; }

 private:
  Box box_;
  double side_ = 0;
  std::uint64_t code_ = 0;
  bool entered_ = false;
  std::pmr::vector<Sphere> spheres_;
};

}  // namespace detp::sim
