#include "structural_registry.hpp"

#include <array>

namespace detp::validate {

// Defined in the files structural_*.cpp.
StructuralCounts structural_brute_force, structural_sphere_cache, structural_cell_spheres, structural_sphere_tree,
    structural_box_tree, structural_octree, structural_grid, structural_bsp;

namespace {

constexpr std::string_view only_run = "it can only be run";

constexpr std::array<StructuralModel, all_techniques.size()> registry{{
    {Technique::brute_force, structural_brute_force},
    {Technique::sphere_cache, structural_sphere_cache},
    {Technique::sphere_cache_published, nullptr, "its walk loses rays"},
    {Technique::cell_spheres, structural_cell_spheres},
    {Technique::sphere_tree, structural_sphere_tree},
    {Technique::box_tree, structural_box_tree},
    {Technique::octree, structural_octree},
    {Technique::grid, structural_grid},
    {Technique::bsp, structural_bsp},
    {Technique::bvh, nullptr, only_run},
    {Technique::ray_map, nullptr, only_run},
    {Technique::photon_map, nullptr, only_run},
}};

}  // namespace

const StructuralModel& structural_model(Technique technique) { return registry[static_cast<std::size_t>(technique)]; }

}  // namespace detp::validate
