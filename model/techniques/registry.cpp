#include "registry.hpp"

#include <array>

namespace detp::model {

// Each is defined in the file of its technique.
DescribeTechnique model_brute_force, model_sphere_cache, model_sphere_cache_published, model_cell_spheres,
    model_sphere_tree, model_box_tree, model_octree, model_grid;

namespace {

struct Listed {
  Technique technique;
  DescribeTechnique* describe;
};

/// A technique without closed forms is not in the list.
constexpr Listed closed_forms[]{
    {Technique::brute_force, model_brute_force},
    {Technique::sphere_cache, model_sphere_cache},
    {Technique::sphere_cache_published, model_sphere_cache_published},
    {Technique::cell_spheres, model_cell_spheres},
    {Technique::sphere_tree, model_sphere_tree},
    {Technique::box_tree, model_box_tree},
    {Technique::octree, model_octree},
    {Technique::grid, model_grid},
};

}  // namespace

const TechniqueModel& model_of(Technique technique) {
  static const auto models = [] {
    std::array<TechniqueModel, technique_records.size()> all{};
    for (const Listed& listed : closed_forms) all[static_cast<std::size_t>(listed.technique)] = listed.describe();
    return all;
  }();
  return models[static_cast<std::size_t>(technique)];
}

}  // namespace detp::model
