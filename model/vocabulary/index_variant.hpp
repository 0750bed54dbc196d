#pragma once

/// Ways to build and to search an index of discs, beside its parameters.
namespace detp {

/// Which cells hold a reference to a disc.
enum class Insertion {
  exact,        ///< those that the disc overlaps
  bounding_box  ///< those that its axis-aligned bounding box overlaps
};

/// How a ray finds the leaves of a tree. (A grid is walked from cell to cell.)
enum class Traversal {
  top_down,  ///< into every child that the ray crosses
  restart    ///< from the root anew for every leaf, and for every octant left out as empty, on the ray's way
};

/// By default what the techniques octree and grid do.
struct IndexVariant {
  Insertion insertion = Insertion::exact;
  bool mailboxing = false;  ///< a disc met in several cells is tested in the first alone
  Traversal traversal = Traversal::top_down;

  bool operator==(const IndexVariant&) const = default;
};

}  // namespace detp
