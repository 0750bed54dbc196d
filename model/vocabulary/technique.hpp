#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "index_variant.hpp"

/// The techniques and their parameters. A new one is one line in each list here, one file in model, one in
/// sim/technique.
namespace detp {

enum class Technique {
  brute_force,
  sphere_cache,
  sphere_cache_published,
  cell_spheres,
  sphere_tree,
  octree,
  grid,
  bsp,
  bvh,
  photon_map
};

inline constexpr std::array all_techniques{
    Technique::brute_force,  Technique::sphere_cache, Technique::sphere_cache_published,
    Technique::cell_spheres, Technique::sphere_tree,  Technique::octree,
    Technique::grid,         Technique::bsp,          Technique::bvh,
    Technique::photon_map};

/// Whether it finds every hit: all but the published sphere cache, which loses some, and the photon map, which looks
/// for none.
[[nodiscard]] constexpr bool finds_all_hits(Technique technique) {
  return technique != Technique::sphere_cache_published && technique != Technique::photon_map;
}

/// Whether the closed forms predict its counts, so that it can be chosen without being run. They know nothing of
/// trees whose shape depends on the samples themselves (bsp, bvh), and what a photon map does is counted otherwise.
[[nodiscard]] constexpr bool has_closed_form(Technique technique) {
  return technique != Technique::bsp && technique != Technique::bvh && technique != Technique::photon_map;
}

/// Whether it looks rays up in an index of the discs, one after another, rather than testing lists of rays.
[[nodiscard]] constexpr bool searches_an_index(Technique technique) {
  return technique == Technique::octree || technique == Technique::grid || technique == Technique::bsp;
}

/// The name on the command line and in files: "sphere-cache".
[[nodiscard]] std::string_view name(Technique technique);

/// The technique of that name, or nothing.
[[nodiscard]] std::optional<Technique> technique_named(std::string_view name);

/// The curve along which the sphere cache visits the samples.
enum class SampleOrder {
  lebesgue,  ///< Morton order, 16 bits a coordinate, X before Y before Z
  hilbert,   ///< along the Hilbert curve through the same cells: each is the neighbour of the one before
  none       ///< as given
};

[[nodiscard]] std::string_view name(SampleOrder order);
[[nodiscard]] std::optional<SampleOrder> order_named(std::string_view name);

/// Every disc against every ray.
struct BruteForceParameters {
  bool operator==(const BruteForceParameters&) const = default;
};

/// Nested spheres of radius r₀Qⁱ with their rays (sphere-cache, and sphere-cache-published).
struct SphereCacheParameters {
  double ratio = 0.65;                        ///< Q, in (0, 1)
  std::int64_t spheres = 1;                   ///< k, the innermost sphere's index, 0 … 9e18; 0: no sphere, any Q
  SampleOrder order = SampleOrder::lebesgue;  ///< in which the samples are visited
  bool operator==(const SphereCacheParameters&) const = default;
};

/// Nested spheres, each around a cell of an octree, with their rays.
struct CellSpheresParameters {
  int depth = 4;  ///< levels of cells below the samples' cube, 0 … 16: the curve's bits
  bool operator==(const CellSpheresParameters&) const = default;
};

/// What bounds the discs below a node of a sphere tree.
enum class Bounds {
  spheres,  ///< nested, over runs of equal length along the curve
  boxes     ///< axis-aligned, over cells of the curve, joined as the surface-area heuristic advises
};

[[nodiscard]] std::string_view name(Bounds bounds);
[[nodiscard]] std::optional<Bounds> bounds_named(std::string_view name);

/// Nested spheres, or boxes, around neighbouring samples: rays are culled down the tree.
struct SphereTreeParameters {
  int fan_out = 8;  ///< nodes that make a parent, 2 … 1 048 576
  int leaf = 4;     ///< samples in a leaf, the last one's may be fewer, 1 … 1 048 576
  Bounds bounds = Bounds::spheres;
  bool operator==(const SphereTreeParameters&) const = default;
};

/// Cube split into 8 at each of `depth` levels, empty nodes left out.
struct OctreeParameters {
  int depth = 6;  ///< levels below the root, 0 … 20
  Traversal traversal = Traversal::top_down;
  bool operator==(const OctreeParameters&) const = default;
};

/// Equal cubic cells.
struct GridParameters {
  int cells = 64;  ///< cells along the longest side, 1 … 1 048 576
  bool operator==(const GridParameters&) const = default;
};

/// Box split in two by planes across its axes, down to leaves of few discs.
struct BspParameters {
  int depth = 32;  ///< most levels below the root, 0 … 64
  int leaf = 64;   ///< a node of so many discs is split no further, 1 … 1 048 576
  bool operator==(const BspParameters&) const = default;
};

/// How much time building a bounding volume hierarchy may take for the rays' sake.
enum class BuildQuality {
  low,    ///< along a Morton curve
  medium  ///< by the surface area heuristic
};

[[nodiscard]] std::string_view name(BuildQuality quality);
[[nodiscard]] std::optional<BuildQuality> quality_named(std::string_view name);

/// Bounding volume hierarchy over the discs' boxes. (Embree's high quality builds the same tree as its medium one where
/// there are no triangles.)
struct BvhParameters {
  BuildQuality quality = BuildQuality::low;
  bool operator==(const BvhParameters&) const = default;
};

/// The nearest photons to each disc's centre.
struct PhotonMapParameters {
  int nearest = 50;  ///< k, photons looked for, 3 … 1 000 000 000, no more than there are
  bool operator==(const PhotonMapParameters&) const = default;
};

using Parameters =
    std::variant<BruteForceParameters, SphereCacheParameters, CellSpheresParameters, SphereTreeParameters,
                 OctreeParameters, GridParameters, BspParameters, BvhParameters, PhotonMapParameters>;

/// One technique with its parameters.
struct Candidate {
  Technique technique = Technique::brute_force;
  Parameters parameters = BruteForceParameters{};
  bool operator==(const Candidate&) const = default;
};

/// The parameters for a reader: "Q 0.607, k 9"; empty where there are none.
[[nodiscard]] std::string describe(const Parameters& parameters);

/// Throws std::invalid_argument where a parameter is out of its range or not one of the technique's.
void check(const Candidate& candidate);

}  // namespace detp
