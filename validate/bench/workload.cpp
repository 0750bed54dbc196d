#include "workload.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

namespace detp::validate {
namespace {

constexpr std::array built_in{"@uniform", "@tree", "@courtyard", "@cornell"};
constexpr std::array meshes{"stanford_bunny.obj", "stanford_dragon.ply", "sponza.ply",     "bedroom.ply",
                            "mountain.obj",       "tangerine_fine.ply",  "grove_fine.ply", "tree.obj"};

/// A million rays are run only at radii of 0.5 and 2 %. At all radii they would take most of the time.
constexpr double most_rays = 1e6;
bool is_used_with_most_rays(const Length& radius) { return radius.value == 0.005 || radius.value == 0.02; }

std::vector<Length> default_radii(BenchEffort effort) {
  if (effort == BenchEffort::quick) return {{0.01, true}, {0.04, true}};
  return {{0.005, true}, {0.01, true}, {0.02, true}, {0.04, true}, {0.08, true}, {0.16, true}};
}

std::vector<double> default_rays(BenchEffort effort) {
  if (effort == BenchEffort::quick) return {1e3, 1e5};
  return {1e3, 1e4, 1e5, most_rays};
}

std::vector<std::optional<double>> samples_of(BenchEffort effort, const BenchAxes& axes, const std::string& scene) {
  if (!axes.samples.empty()) return {axes.samples.begin(), axes.samples.end()};
  if (scene == "@uniform" && effort == BenchEffort::thorough) return {1e3, 1e5, 1e6};
  return {std::nullopt};
}

std::vector<sim::Field> fields_of(const BenchAxes& axes, const std::string& scene) {
  if (!axes.fields.empty()) return axes.fields;
  if (scene == "@uniform") return {sim::Field::isotropic};
  return {sim::Field::isotropic, sim::Field::photons};
}

void add_scene(BenchEffort effort, const BenchAxes& axes, const std::string& scene, const std::string& path,
               BenchSet& set) {
  const std::vector<Length> radii = axes.disc_radii.empty() ? default_radii(effort) : axes.disc_radii;
  std::vector<double> rays = axes.rays.empty() ? default_rays(effort) : axes.rays;
  std::sort(rays.begin(), rays.end());
  for (const sim::Field field : fields_of(axes, scene))
    for (const auto& samples : samples_of(effort, axes, scene))
      for (const Length& radius : radii)
        for (const double count : rays) {
          const bool thinned = axes.rays.empty() && axes.disc_radii.empty() && count == most_rays;
          if (!thinned || is_used_with_most_rays(radius))
            set.workloads.push_back({scene, path, field, samples, radius, count});
        }
}

}  // namespace

bool same_but_rays(const BenchWorkload& a, const BenchWorkload& b) {
  return a.path == b.path && a.field == b.field && a.samples == b.samples &&
         a.disc_radius.value == b.disc_radius.value && a.disc_radius.relative == b.disc_radius.relative;
}

BenchSet bench_set(BenchEffort effort, const BenchAxes& axes, const std::string& folder) {
  BenchSet set;
  if (axes.scene) {
    const bool mesh = !axes.scene->starts_with('@');
    add_scene(effort, axes, mesh ? std::filesystem::path(*axes.scene).stem().string() : *axes.scene, *axes.scene, set);
    return set;
  }
  for (const char* scene : built_in)
    // @uniform has no light. It is left out if only photon paths are requested.
    if (scene != std::string("@uniform") || axes.fields != std::vector{sim::Field::photons}) {
      BenchAxes own = axes;
      if (scene == std::string("@uniform")) own.fields.clear();
      add_scene(effort, own, scene, scene, set);
    }
  const std::size_t wanted = effort == BenchEffort::quick ? 1 : meshes.size();
  for (std::size_t i = 0; i < wanted; ++i) {
    const std::filesystem::path mesh(meshes[i]);
    if (folder.empty())
      set.missing.push_back(mesh.stem().string() + ": DETP_SCENES, the folder of its file, is not set");
    else if (!std::filesystem::exists(folder / mesh))
      set.missing.push_back(mesh.stem().string() + ": " + (folder / mesh).string() + " does not exist");
    else
      add_scene(effort, axes, mesh.stem().string(), (folder / mesh).string(), set);
  }
  return set;
}

}  // namespace detp::validate
