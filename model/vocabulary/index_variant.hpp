#pragma once

/// Variants of building and searching an index of discs, apart from its size.
namespace detp {

/// Which cells hold a reference to a disc.
enum class Insertion {
  exact,        ///< cells that the disc overlaps
  bounding_box  ///< cells that its axis-aligned bounding box overlaps
};

/// The defaults are those of the techniques octree and grid.
struct IndexVariant {
  Insertion insertion = Insertion::exact;
  bool mailboxing = false;  ///< a ray tests a disc only in the first cell on its way that refers to the disc

  bool operator==(const IndexVariant&) const = default;
};

}  // namespace detp
