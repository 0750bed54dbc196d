#pragma once

#include <array>
#include <optional>
#include <string_view>

/// Ways to build and to search an index of discs, beside its size.
namespace detp {

/// Which cells hold a reference to a disc.
enum class Insertion {
  exact,        ///< those that the disc overlaps
  bounding_box  ///< those that its axis-aligned bounding box overlaps
};

/// How a ray finds the leaves of an octree. (A grid is walked from cell to cell.)
enum class Traversal {
  top_down,        ///< into every child that the ray crosses
  front_to_back,   ///< into the same children, in the order in which the ray enters them
  restart,         ///< from the root anew for every leaf, and for every octant left out as empty, on the ray's way
  neighbour_links  ///< the same leaves and octants, each by its link from the one before: never back to the root
};

inline constexpr std::array all_traversals{Traversal::top_down, Traversal::front_to_back, Traversal::restart,
                                           Traversal::neighbour_links};

/// The name on the command line and in files: "top-down".
[[nodiscard]] std::string_view name(Traversal traversal);

/// The traversal of that name, or nothing.
[[nodiscard]] std::optional<Traversal> traversal_named(std::string_view name);

/// By default what the techniques octree and grid do.
struct IndexVariant {
  Insertion insertion = Insertion::exact;
  bool mailboxing = false;  ///< a disc met in several cells is tested in the first alone

  bool operator==(const IndexVariant&) const = default;
};

}  // namespace detp
