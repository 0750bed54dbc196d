#pragma once

#include <cstdint>
#include <string_view>
#include <variant>

#include "parameter.hpp"

/// The parameters of each technique. Ranges and help are in the tables of technique.hpp.
namespace detp {

/// Every disc against every ray.
struct BruteForceParameters {
  bool operator==(const BruteForceParameters&) const = default;
};

/// The curve along which the sphere cache visits the samples.
enum class SampleOrder {
  lebesgue,  ///< Morton order (the paper: Lebesgue), 16 bits a coordinate, X before Y before Z
  hilbert,   ///< along the Hilbert curve through the same cells: each is the neighbour of the one before
  none       ///< as given
};
template <>
inline constexpr std::array<std::string_view, 3> choice_names<SampleOrder>{"lebesgue", "hilbert", "none"};

/// Nested spheres of radius r₀Qⁱ with their rays (sphere-cache, and sphere-cache-published).
struct SphereCacheParameters {
  double ratio = 0.65;       ///< Q
  std::int64_t spheres = 1;  ///< k, the innermost sphere's index; 0: no sphere, any Q
  SampleOrder order = SampleOrder::lebesgue;
  bool operator==(const SphereCacheParameters&) const = default;
};

/// Nested spheres, each around a cell of an octree, with their rays.
struct CellSpheresParameters {
  int depth = 4;  ///< levels of cells below the samples' cube
  bool operator==(const CellSpheresParameters&) const = default;
};

/// Nested spheres around runs of samples along the curve: lists of rays are culled down the tree.
struct SphereTreeParameters {
  int fan_out = 8;  ///< nodes that make a parent
  int leaf = 4;     ///< samples in a leaf, the last one's may be fewer
  bool operator==(const SphereTreeParameters&) const = default;
};

/// Axis-aligned boxes around cells of the curve, joined where that pays: lists of rays are culled down the tree.
struct BoxTreeParameters {
  int fan_out = 4;  ///< most children of a node
  int leaf = 16;    ///< most samples in a leaf, except where splitting does not pay
  bool operator==(const BoxTreeParameters&) const = default;
};

/// How a ray finds the leaves of an octree. (A grid is walked from cell to cell.)
enum class Traversal {
  top_down,        ///< into every child that the ray crosses
  front_to_back,   ///< into the same children, in the order in which the ray enters them
  restart,         ///< from the root again for every leaf, and for every octant left out as empty, on the ray's way
  neighbour_links  ///< the same leaves and octants, each by its link from the one before: never back to the root
};
template <>
inline constexpr std::array<std::string_view, 4> choice_names<Traversal>{"top-down", "front-to-back", "restart",
                                                                         "neighbour-links"};

/// Cube split into 8 at each of `depth` levels, empty nodes left out.
struct OctreeParameters {
  int depth = 6;  ///< levels below the root
  Traversal traversal = Traversal::top_down;
  bool operator==(const OctreeParameters&) const = default;
};

/// Equal cubic cells.
struct GridParameters {
  int cells = 64;  ///< cells along the longest side
  bool operator==(const GridParameters&) const = default;
};

/// Box split in two by planes across its axes, down to leaves of few discs.
struct BspParameters {
  int depth = 32;  ///< most levels below the root
  int leaf = 64;   ///< a node of so many discs is split no further
  bool operator==(const BspParameters&) const = default;
};

/// How much time building a bounding volume hierarchy may take for the rays' sake.
enum class BuildQuality {
  low,    ///< along a Morton curve
  medium  ///< by the surface area heuristic
};
template <>
inline constexpr std::array<std::string_view, 2> choice_names<BuildQuality>{"low", "medium"};

/// Bounding volume hierarchy over the discs' boxes. (Embree's high quality builds the same tree as its medium one where
/// there are no triangles.)
struct BvhParameters {
  BuildQuality quality = BuildQuality::low;
  bool operator==(const BvhParameters&) const = default;
};

/// A kd-tree over the rays, built where discs look.
struct RayMapParameters {
  int leaf = 32;  ///< a cell of so many rays is split no further
  bool operator==(const RayMapParameters&) const = default;
};

/// The nearest photons to each disc's centre.
struct PhotonMapParameters {
  int nearest = 50;  ///< k, photons looked for, no more than there are
  bool operator==(const PhotonMapParameters&) const = default;
};

using Parameters = std::variant<BruteForceParameters, SphereCacheParameters, CellSpheresParameters,
                                SphereTreeParameters, BoxTreeParameters, OctreeParameters, GridParameters,
                                BspParameters, BvhParameters, RayMapParameters, PhotonMapParameters>;

}  // namespace detp
