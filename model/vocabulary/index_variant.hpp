#pragma once

/// Ways to build and to search an index of discs, beside its size.
namespace detp {

/// Which cells hold a reference to a disc.
enum class Insertion {
  exact,        ///< those that the disc overlaps
  bounding_box  ///< those that its axis-aligned bounding box overlaps
};

/// By default what the techniques octree and grid do.
struct IndexVariant {
  Insertion insertion = Insertion::exact;
  bool mailboxing = false;  ///< a disc met in several cells is tested in the first alone

  bool operator==(const IndexVariant&) const = default;
};

}  // namespace detp
