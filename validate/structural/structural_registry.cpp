#include "structural_registry.hpp"

namespace detp::validate {

// Defined in the files structural_*.cpp.
StructuralCounts structural_brute_force, structural_sphere_cache, structural_cell_spheres, structural_sphere_tree,
    structural_box_tree, structural_octree, structural_grid, structural_bsp;

namespace {

/// A technique that is not in the list can only be run.
constexpr StructuralModel registry[]{
    {Technique::brute_force, structural_brute_force},
    {Technique::sphere_cache, structural_sphere_cache},
    {Technique::sphere_cache_published, nullptr, "its walk loses rays"},
    {Technique::cell_spheres, structural_cell_spheres},
    {Technique::sphere_tree, structural_sphere_tree},
    {Technique::box_tree, structural_box_tree},
    {Technique::octree, structural_octree},
    {Technique::grid, structural_grid},
    {Technique::bsp, structural_bsp},
};

}  // namespace

StructuralModel structural_model(Technique technique) {
  for (const StructuralModel& model : registry)
    if (model.technique == technique) return model;
  return {technique, nullptr, "it can only be run"};
}

}  // namespace detp::validate
