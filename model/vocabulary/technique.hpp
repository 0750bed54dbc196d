#pragma once

#include <algorithm>
#include <concepts>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "parameters.hpp"

/// The techniques, one record each. CONTRIBUTING.md says what a new technique needs.
namespace detp {

/// Whether this build has Embree, which bvh needs.
#ifdef DETP_WITHOUT_EMBREE
inline constexpr bool has_embree = false;
#else
inline constexpr bool has_embree = true;
#endif

enum class Technique {
  brute_force,
  sphere_cache,
  sphere_cache_published,
  cell_spheres,
  sphere_tree,
  box_tree,
  octree,
  grid,
  bsp,
  bvh,
  ray_map,
  photon_map
};

using Parameter = ParameterRecord<Parameters>;

namespace records {

template <auto member>
[[nodiscard]] constexpr Parameter number(std::string_view name, std::string_view what, double least, double most,
                                         ParameterValue small, std::string_view help, double step = 1.4) {
  using Access = ParameterAccess<Parameters, member>;
  return {name, name, what, help, least, most, small, {}, step, Access::get, Access::set};
}

template <auto member, NamedEnum E>
[[nodiscard]] constexpr Parameter choice(std::string_view name, E small, std::string_view help) {
  using Access = ParameterAccess<Parameters, member>;
  return {name, name, name, help, 0, 0, detp::name(small), choice_names<E>, 0, Access::get, Access::set};
}

[[nodiscard]] constexpr Parameter shown_as(std::string_view symbol, Parameter parameter) {
  parameter.symbol = symbol;
  return parameter;
}

using std::int64_t;
inline constexpr double most_parts = 1048576;

inline constexpr std::array sphere_cache{
    shown_as("Q", number<&SphereCacheParameters::ratio>("ratio", "radius ratio Q", 0, 1, 0.65,
                                                        "radius of a sphere over that of the next larger one", 1.15)),
    shown_as("k", number<&SphereCacheParameters::spheres>("spheres", "number of spheres", 0, 9e18, int64_t{8},
                                                          "k, the innermost sphere", 0)),
    choice<&SphereCacheParameters::order>("order", SampleOrder::lebesgue, "order in which samples are visited")};

inline constexpr std::array cell_spheres{
    number<&CellSpheresParameters::depth>("depth", "depth", 0, 16, int64_t{3}, "levels of cells with spheres", 0)};

inline constexpr std::array sphere_tree{
    number<&SphereTreeParameters::fan_out>("fan-out", "fan-out", 2, most_parts, int64_t{4}, "children of a node", 2),
    number<&SphereTreeParameters::leaf>("leaf", "number of samples in a leaf", 1, most_parts, int64_t{2},
                                        "samples in a leaf", 4)};

inline constexpr std::array box_tree{
    number<&BoxTreeParameters::fan_out>("fan-out", "fan-out", 2, most_parts, int64_t{2}, "most children of a node", 2),
    number<&BoxTreeParameters::leaf>("leaf", "number of samples in a leaf", 1, most_parts, int64_t{1},
                                     "most samples in a leaf", 4)};

inline constexpr std::array octree{
    number<&OctreeParameters::depth>("depth", "depth", 0, 20, int64_t{3}, "levels of an octree", 0),
    choice<&OctreeParameters::traversal>("traversal", Traversal::top_down, "how rays go through an octree")};

inline constexpr std::array grid{number<&GridParameters::cells>("cells", "number of cells a side", 1, most_parts,
                                                                int64_t{7}, "cells along the longest side")};

inline constexpr std::array bsp{
    number<&BspParameters::depth>("depth", "depth", 0, 64, int64_t{12}, "most levels of a BSP tree", 0),
    number<&BspParameters::leaf>("leaf", "number of discs in a leaf", 1, most_parts, int64_t{1},
                                 "discs in a leaf that is split no further", 4)};

inline constexpr std::array bvh{
    choice<&BvhParameters::quality>("quality", BuildQuality::low, "how carefully a BVH is built")};

inline constexpr std::array ray_map{number<&RayMapParameters::leaf>(
    "leaf", "number of rays in a leaf", 1, most_parts, int64_t{2}, "rays in a cell that is split no further", 4)};

inline constexpr std::array photon_map{
    number<&PhotonMapParameters::nearest>("nearest", "number of nearest photons", 3, 1e9, int64_t{3},
                                          "photons that are looked for"),
    choice<&PhotonMapParameters::form>("nearest-form", NearestForm::unbiased,
                                       "k - 1 photons up to the k-th, or all k, as published")};

}  // namespace records

/// The pieces into which a search is divided among threads.
enum class Division {
  none,   ///< one thread searches
  rays,   ///< chunks of rays_in_chunk rays
  discs,  ///< chunks of discs_in_chunk discs
  axes,   ///< the rays by the dominant axis of their directions: three pieces
  nodes   ///< subtrees (rays_to_divide)
};

struct WorkDivision {
  Division plain = Division::none;  ///< of the search by the plain engine
  Division simd = Division::none;   ///< of the search by the simd engine
  bool preparing = false;           ///< sorting and building are divided, too
};

/// Properties of a technique that do not depend on a run.
struct TechniqueRecord {
  Technique technique;
  std::string_view name;  ///< on the command line and in files
  std::span<const Parameter> parameters;
  Parameters defaults;
  bool exact = true;        ///< finds every hit
  bool ray_by_ray = false;  ///< a search goes ray by ray or disc by disc, not by lists of rays; its tests cost w
  bool simd = false;        ///< has a simd engine
  bool built = true;        ///< this build of the library has it
  WorkDivision division = {};
};

inline constexpr std::array technique_records{
    TechniqueRecord{.technique = Technique::brute_force,
                    .name = "brute-force",
                    .parameters = {},
                    .defaults = BruteForceParameters{},
                    .simd = true,
                    .division = {.plain = Division::rays, .simd = Division::discs}},
    TechniqueRecord{.technique = Technique::sphere_cache,
                    .name = "sphere-cache",
                    .parameters = records::sphere_cache,
                    .defaults = SphereCacheParameters{},
                    .simd = true,
                    .division = {.simd = Division::axes}},
    TechniqueRecord{.technique = Technique::sphere_cache_published,
                    .name = "sphere-cache-published",
                    .parameters = records::sphere_cache,
                    .defaults = SphereCacheParameters{},
                    .exact = false},
    TechniqueRecord{.technique = Technique::cell_spheres,
                    .name = "cell-spheres",
                    .parameters = records::cell_spheres,
                    .defaults = CellSpheresParameters{},
                    .simd = true,
                    .division = {.simd = Division::axes}},
    TechniqueRecord{.technique = Technique::sphere_tree,
                    .name = "sphere-tree",
                    .parameters = records::sphere_tree,
                    .defaults = SphereTreeParameters{}},
    TechniqueRecord{.technique = Technique::box_tree,
                    .name = "box-tree",
                    .parameters = records::box_tree,
                    .defaults = BoxTreeParameters{},
                    .simd = true,
                    .division = {.simd = Division::nodes, .preparing = true}},
    TechniqueRecord{.technique = Technique::octree,
                    .name = "octree",
                    .parameters = records::octree,
                    .defaults = OctreeParameters{},
                    .ray_by_ray = true,
                    .simd = true,
                    .division = {.plain = Division::rays, .simd = Division::rays}},
    TechniqueRecord{.technique = Technique::grid,
                    .name = "grid",
                    .parameters = records::grid,
                    .defaults = GridParameters{},
                    .ray_by_ray = true,
                    .simd = true,
                    .division = {.plain = Division::rays, .simd = Division::rays}},
    TechniqueRecord{.technique = Technique::bsp,
                    .name = "bsp",
                    .parameters = records::bsp,
                    .defaults = BspParameters{},
                    .ray_by_ray = true,
                    .simd = true,
                    .division = {.plain = Division::rays, .simd = Division::rays}},
    TechniqueRecord{.technique = Technique::bvh,
                    .name = "bvh",
                    .parameters = records::bvh,
                    .defaults = BvhParameters{},
                    .ray_by_ray = true,
                    .simd = true,
                    .built = has_embree,
                    .division = {.plain = Division::rays, .simd = Division::rays, .preparing = true}},
    TechniqueRecord{.technique = Technique::ray_map,
                    .name = "ray-map",
                    .parameters = records::ray_map,
                    .defaults = RayMapParameters{},
                    .ray_by_ray = true,
                    .simd = true},
    TechniqueRecord{.technique = Technique::photon_map,
                    .name = "photon-map",
                    .parameters = records::photon_map,
                    .defaults = PhotonMapParameters{},
                    .exact = false,
                    .ray_by_ray = true}};

[[nodiscard]] constexpr const TechniqueRecord& record_of(Technique technique) {
  return technique_records[static_cast<std::size_t>(technique)];
}

static_assert([] {
  for (std::size_t i = 0; i < technique_records.size(); ++i)
    if (technique_records[i].technique != static_cast<Technique>(i)) return false;
  return true;
}());

/// The techniques that this build has, in the order of the records; if `only_exact`, those that find every hit.
template <bool only_exact>
inline constexpr auto built_techniques = [] {
  constexpr auto is_one = [](const TechniqueRecord& record) { return record.built && (record.exact || !only_exact); };
  constexpr auto count = std::ranges::count_if(technique_records, is_one);
  std::array<Technique, count> found{};
  std::size_t place = 0;
  for (const TechniqueRecord& record : technique_records)
    if (is_one(record)) found[place++] = record.technique;
  return found;
}();

/// Every technique, in the order of the records. Those that find every hit, and so can be chosen: exact_techniques.
inline constexpr auto all_techniques = built_techniques<false>;

/// The techniques that find every hit, in the order of the records: the candidates of a choice.
inline constexpr auto exact_techniques = built_techniques<true>;

[[nodiscard]] constexpr std::string_view name(Technique technique) { return record_of(technique).name; }

/// The technique with that name; nullopt if there is none, or if this build lacks it.
[[nodiscard]] std::optional<Technique> technique_named(std::string_view name);

struct Candidate {
  Technique technique = Technique::brute_force;
  Parameters parameters = BruteForceParameters{};
  bool operator==(const Candidate&) const = default;
};

[[nodiscard]] constexpr Candidate default_candidate(Technique technique) {
  return {technique, record_of(technique).defaults};
}

/// The technique's parameter with that name; null if there is none.
[[nodiscard]] const Parameter* find_parameter(Technique technique, std::string_view name);

/// Changes a parameter. Throws std::invalid_argument if the value is out of range or of another kind, or if the
/// technique has no such parameter.
void set_parameter(Candidate& candidate, std::string_view name, const ParameterValue& value);

/// The parameters as text: "Q 0.607, k 9". A default choice is not shown if the technique has other parameters too.
/// Empty if there are no parameters.
[[nodiscard]] std::string describe(const Candidate& candidate);

/// The technique and its parameters: "box-tree, fan-out 4, leaf 16".
[[nodiscard]] std::string title(const Candidate& candidate);

/// Throws std::invalid_argument if a parameter is out of range or does not belong to the technique.
void check(const Candidate& candidate);

/// Throws std::invalid_argument if one of the parameters is out of range.
template <class Own>
requires std::constructible_from<Parameters, Own>
void check(const Own& parameters) {
  for (const TechniqueRecord& record : technique_records)
    if (std::holds_alternative<Own>(record.defaults)) return check(Candidate{record.technique, parameters});
}

/// Variants for tests on few samples. In the first, every parameter has its value `small`. Each other one differs from
/// the first in one parameter: a whole number has its smallest value, a choice any of its other values.
[[nodiscard]] std::vector<Candidate> small_variants(Technique technique);

}  // namespace detp
