#pragma once

#include <cstdint>
#include <string_view>
#include <variant>

#include "parameter.hpp"

/// The parameters of each technique. The tables in technique.hpp have their ranges and help.
namespace detp {

/// Tests every disc against every ray.
struct BruteForceParameters {
  bool operator==(const BruteForceParameters&) const = default;
};

/// The curve along which the sphere cache visits the samples.
enum class SampleOrder {
  lebesgue,  ///< Morton order (the paper: Lebesgue), 16 bits a coordinate, X before Y before Z
  hilbert,   ///< Hilbert curve through the same cells; consecutive cells share a face
  none       ///< in the order of the input
};
template <>
inline constexpr std::array<std::string_view, 3> choice_names<SampleOrder>{"lebesgue", "hilbert", "none"};

/// Nested spheres of radius r₀Qⁱ with lists of their rays (sphere-cache, and sphere-cache-published).
struct SphereCacheParameters {
  double ratio = 0.65;       ///< Q
  std::int64_t spheres = 1;  ///< k, the innermost sphere's index; 0: no sphere, whatever Q is
  SampleOrder order = SampleOrder::lebesgue;
  bool operator==(const SphereCacheParameters&) const = default;
};

/// Nested spheres, each around a cell of an octree, with lists of their rays.
struct CellSpheresParameters {
  int depth = 4;  ///< levels of cells below the samples' cube
  bool operator==(const CellSpheresParameters&) const = default;
};

/// A tree of nested spheres around runs of samples along the curve. Lists of rays are culled down the tree.
struct SphereTreeParameters {
  int fan_out = 8;  ///< children of a node
  int leaf = 4;     ///< samples in a leaf; the last leaf may have fewer
  bool operator==(const SphereTreeParameters&) const = default;
};

/// A tree of axis-aligned boxes around the discs of the curve's cells. A cell whose halves would cost more than the
/// cell is not split. Lists of rays are culled down the tree.
struct BoxTreeParameters {
  int fan_out = 4;  ///< maximum number of children of a node
  int leaf = 16;    ///< maximum number of samples in a leaf, unless splitting would cost more
  bool operator==(const BoxTreeParameters&) const = default;
};

/// How a ray finds the leaves of an octree.
enum class Traversal {
  top_down,       ///< from the root into every child that the ray crosses
  front_to_back,  ///< into the same children, in the order in which the ray enters them
  restart,        ///< from the root again for every leaf and every omitted empty octant that the ray crosses
  /// the same leaves and octants as restart, but each is reached by a link from the previous one
  neighbour_links
};
template <>
inline constexpr std::array<std::string_view, 4> choice_names<Traversal>{"top-down", "front-to-back", "restart",
                                                                         "neighbour-links"};

/// A cube, split into 8 at each of `depth` levels; empty nodes are omitted.
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

/// A box split in two by planes across its axes, down to leaves with few discs.
struct BspParameters {
  int depth = 32;  ///< maximum number of levels below the root
  int leaf = 64;   ///< a node with at most this many discs is not split
  bool operator==(const BspParameters&) const = default;
};

/// How a bounding volume hierarchy is built. Medium builds longer and searches faster.
enum class BuildQuality {
  low,    ///< along a Morton curve
  medium  ///< by the surface area heuristic
};
template <>
inline constexpr std::array<std::string_view, 2> choice_names<BuildQuality>{"low", "medium"};

/// Bounding volume hierarchy over the discs' boxes. (Without triangles, Embree's high quality builds the same tree as
/// medium.)
struct BvhParameters {
  BuildQuality quality = BuildQuality::low;
  bool operator==(const BvhParameters&) const = default;
};

/// A kd-tree over the rays. Cells are only split when a disc searches them.
struct RayMapParameters {
  int leaf = 128;  ///< a cell with at most this many rays is not split
  bool operator==(const RayMapParameters&) const = default;
};

/// What the k nearest photons are taken for (model/accuracy/nearest_photons.hpp).
enum class NearestForm {
  unbiased,  ///< k - 1 of them over the area up to the k-th
  plain      ///< all k over this area, as published: k/(k - 1) times too large where photons lie evenly
};
template <>
inline constexpr std::array<std::string_view, 2> choice_names<NearestForm>{"unbiased", "plain"};

/// Estimates irradiance from the photons nearest to each disc's centre.
struct PhotonMapParameters {
  int nearest = 50;  ///< k, number of photons searched for; all photons if there are fewer
  NearestForm form = NearestForm::unbiased;
  bool operator==(const PhotonMapParameters&) const = default;
};

using Parameters = std::variant<BruteForceParameters, SphereCacheParameters, CellSpheresParameters,
                                SphereTreeParameters, BoxTreeParameters, OctreeParameters, GridParameters,
                                BspParameters, BvhParameters, RayMapParameters, PhotonMapParameters>;

// Variants of building and searching an index of discs, apart from its size.

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
