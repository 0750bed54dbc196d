#include "registry.hpp"

#include <array>

#include "detp/sim/base/floating_point.hpp"

namespace detp::sim {

// Each is defined in its own file.
Prepare prepare_brute_force, prepare_sphere_cache, prepare_sphere_cache_published, prepare_cell_spheres,
    prepare_sphere_tree, prepare_box_tree, prepare_octree, prepare_grid, prepare_bsp, prepare_bvh, prepare_ray_map,
    prepare_photon_map;

namespace {

constexpr std::array<TechniqueSearch, all_techniques.size()> registry{{
    {Technique::brute_force, prepare_brute_force},
    {Technique::sphere_cache, prepare_sphere_cache},
    {Technique::sphere_cache_published, prepare_sphere_cache_published},
    {Technique::cell_spheres, prepare_cell_spheres},
    {Technique::sphere_tree, prepare_sphere_tree},
    {Technique::box_tree, prepare_box_tree},
    {Technique::octree, prepare_octree},
    {Technique::grid, prepare_grid},
    {Technique::bsp, prepare_bsp},
    {Technique::bvh, prepare_bvh},
    {Technique::ray_map, prepare_ray_map},
    {Technique::photon_map, prepare_photon_map},
}};

}  // namespace

const TechniqueSearch& search_of(Technique technique) { return registry[static_cast<std::size_t>(technique)]; }

std::unique_ptr<Index> prepare(const Problem& problem, const Valid<Candidate>& candidate, const RunOptions& options) {
  const DefaultFloatingPoint mode;
  return search_of(candidate.technique).prepare(problem, candidate.parameters, options);
}

}  // namespace detp::sim
