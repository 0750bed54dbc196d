#include "workload.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "detp/sim/geometry/random.hpp"
#include "detp/sim/scene/families/families.hpp"

namespace detp::validate {
namespace {

struct Mesh {
  const char* file;
  bool judges_choices;  ///< choices are judged on it, too
};
constexpr std::array meshes{Mesh{"stanford_bunny.obj", true}, Mesh{"stanford_dragon.ply", false},
                            Mesh{"sponza.ply", true},         Mesh{"bedroom.ply", true},
                            Mesh{"mountain.obj", true},       Mesh{"tangerine_fine.ply", false},
                            Mesh{"grove_fine.ply", true},     Mesh{"tree.obj", false}};

/// Calls add(stem, path) for each mesh whose file is in the folder. The names of the others go to `missing`, with the reason.
template <class Add>
void for_each_mesh(std::span<const Mesh> wanted, const std::string& folder, std::vector<std::string>& missing,
                   const Add& add) {
  for (const Mesh& mesh : wanted) {
    const std::filesystem::path path = std::filesystem::path(folder) / mesh.file;
    const std::string stem = path.stem().string();
    if (folder.empty())
      missing.push_back(stem + ": DETP_SCENES, the folder of its file, is not set");
    else if (!std::filesystem::exists(path))
      missing.push_back(stem + ": " + path.string() + " does not exist");
    else
      add(stem, path.string());
  }
}

constexpr std::array built_in{"@uniform", "@tree", "@courtyard", "@cornell"};

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
            set.workloads.push_back({.scene = scene,
                                     .discs = path,
                                     .field = field,
                                     .samples = samples,
                                     .disc_radius = radius,
                                     .rays = count});
        }
}

constexpr std::array radii{0.0025, 0.01, 0.04, 0.16};
constexpr std::array ray_counts{1e2, 1e3, 1e4, 1e5, 1e6};
constexpr double most_hits = 3e7;        ///< expected if the discs are spread out
constexpr double usual_vertices = 1e5;   ///< order of magnitude, of scenes with a sample for each vertex
constexpr std::size_t quick_stride = 3;  ///< the quick effort takes every third workload

struct RegretScene {
  std::string name;
  std::variant<std::string, AwkwardScene> discs;
  bool light = false;
  std::vector<std::optional<double>> samples = {std::nullopt};
  bool held_out = false;
};

RegretScene awkward(AwkwardScene scene, std::vector<std::optional<double>> samples, bool held_out) {
  return {std::string(name(scene)), scene, false, std::move(samples), held_out};
}

std::vector<RegretScene> scenes_of(BenchEffort effort, const std::string& folder, std::vector<std::string>& missing) {
  const bool all = effort == BenchEffort::thorough;
  using Samples = std::vector<std::optional<double>>;
  const Samples vertices = all ? Samples{std::nullopt} : Samples{1e4};
  const Samples many = all ? Samples{1e4, 1e5} : Samples{1e4};
  std::vector<RegretScene> scenes{
      {"@uniform", "@uniform", false, all ? Samples{1e2, 1e3, 1e4, 1e5, 1e6} : Samples{1e3, 1e4}},
      {"@tree", "@tree", true, vertices},
      {"@courtyard", "@courtyard", true, vertices},
      awkward(AwkwardScene::clusters, many, false),
      awkward(AwkwardScene::strays, {1e4}, false),
      {"@cornell", "@cornell", true, vertices, true},
      awkward(AwkwardScene::tiny_object, many, true),
      awkward(AwkwardScene::thin_sheet, {1e4}, true),
      awkward(AwkwardScene::mixed_radii, {1e4}, true)};
  if (!all) return scenes;
  std::vector<Mesh> used;
  std::ranges::copy_if(meshes, std::back_inserter(used), &Mesh::judges_choices);
  for_each_mesh(used, folder, missing, [&](const std::string& stem, const std::string& path) {
    scenes.push_back({stem, path, true, {std::nullopt}, true});
  });
  return scenes;
}

bool is_in(BenchEffort effort, const BenchWorkload& one, std::size_t place) {
  if (effort == BenchEffort::quick && (one.rays > 1e4 || one.rays < 1e3 || place % quick_stride != 0)) return false;
  const double radius = one.disc_radius.value;
  if (one.rays * one.samples.value_or(usual_vertices) * radius * radius > most_hits) return false;
  return one.rays < 1e6 || radius < 0.02;
}

}  // namespace

bool same_but_rays(const BenchWorkload& a, const BenchWorkload& b) {
  return a.discs == b.discs && a.field == b.field && a.samples == b.samples && a.disc_radius == b.disc_radius;
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
  const std::span<const Mesh> wanted =
      std::span<const Mesh>(meshes).first(effort == BenchEffort::quick ? 1 : meshes.size());
  for_each_mesh(wanted, folder, set.missing,
                [&](const std::string& stem, const std::string& path) { add_scene(effort, axes, stem, path, set); });
  return set;
}

BenchSet regret_set(BenchEffort effort, const std::string& folder) {
  BenchSet set;
  std::size_t place = 0;
  for (const RegretScene& scene : scenes_of(effort, folder, set.missing))
    for (const auto& samples : scene.samples)
      for (const sim::Field field : {sim::Field::isotropic, sim::Field::photons})
        for (const double radius : radii)
          for (const double rays : ray_counts) {
            if (field == sim::Field::photons && !scene.light) continue;
            const BenchWorkload one{scene.name, scene.discs, field, samples, {radius, true}, rays, scene.held_out};
            if (is_in(effort, one, place++)) set.workloads.push_back(one);
          }
  return set;
}

std::vector<BenchWorkload> family_workloads(std::uint64_t seed) {
  constexpr int scenes_of_family = 2;
  constexpr int workloads_of_scene = 7;
  constexpr int photons_of_scene = 5;
  std::vector<BenchWorkload> workloads;
  std::uint64_t place = 0;
  for (const sim::families::Family& family : sim::families::all_families)
    for (int scene = 0; scene < scenes_of_family; ++scene)
      for (int i = 0; i < workloads_of_scene; ++i) {
        const std::string name = fmt::format("@{}:{}", family.name, 100 * seed + static_cast<std::uint64_t>(scene));
        const sim::Field field = i < photons_of_scene ? sim::Field::photons : sim::Field::isotropic;
        const auto random = sim::uniform4(seed, sim::Stream::scene, place++);
        const double radius = radii.front() * std::pow(radii.back() / radii.front(), random[0]);
        const double most_rays = std::min(ray_counts.back(), most_hits / (usual_vertices * radius * radius));
        const double rays = std::round(ray_counts.front() * std::pow(most_rays / ray_counts.front(), random[1]));
        workloads.push_back({name, name, field, std::nullopt, {radius, true}, rays, true});
      }
  return workloads;
}

}  // namespace detp::validate
