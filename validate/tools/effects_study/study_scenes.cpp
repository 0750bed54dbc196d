#include "study_scenes.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

namespace detp::study {
namespace {

using validate::AwkwardScene;

constexpr std::array<std::string_view, 12> tuned_on{
    "@tree",    "@courtyard", "@cornell",       "stanford_bunny", "sponza",          "bedroom",
    "mountain", "grove_fine", "tangerine_fine", "cornell_box",    "stanford_dragon", "tree"};
constexpr double generated_discs = 20'000;
constexpr std::array<std::string_view, 2> same_in_other_units{"huge_scale", "tiny_scale"};  // as huge_offset

bool is_tuned(std::string_view name) { return std::ranges::find(tuned_on, name) != tuned_on.end(); }

std::vector<StudyScene> meshes_in(const std::string& folder) {
  std::vector<StudyScene> meshes;
  if (folder.empty()) return meshes;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string type = entry.path().extension().string();
    if (!entry.is_regular_file() || (type != ".obj" && type != ".ply")) continue;
    const std::string name = entry.path().stem().string();
    if (std::ranges::find(same_in_other_units, name) != same_in_other_units.end()) continue;
    meshes.push_back({name, entry.path().string(), true, is_tuned(name)});
  }
  std::ranges::sort(meshes, {}, &StudyScene::name);
  return meshes;
}

}  // namespace

std::vector<StudyScene> study_scenes(const std::string& folder) {
  std::vector<StudyScene> scenes;
  for (const char* name : {"@tree", "@courtyard", "@cornell", "@tree-coarse", "@caustic", "@interior"})
    scenes.push_back({name, name, true, is_tuned(name)});
  scenes.push_back({"@uniform", "@uniform"});
  for (const AwkwardScene scene : {AwkwardScene::clusters, AwkwardScene::tiny_object, AwkwardScene::thin_sheet,
                                   AwkwardScene::strays, AwkwardScene::mixed_radii})
    scenes.push_back({std::string(validate::name(scene)), scene});
  for (StudyScene& mesh : meshes_in(folder)) scenes.push_back(std::move(mesh));
  return scenes;
}

std::vector<validate::RegretWorkload> with_fields(const StudyScene& scene, double radius, double rays) {
  const double samples = std::holds_alternative<std::string>(scene.discs) ? 0 : generated_discs;
  std::vector<validate::RegretWorkload> all;
  for (const sim::Field field : {sim::Field::isotropic, sim::Field::photons})
    if (field == sim::Field::isotropic || scene.light)
      all.push_back({scene.name, scene.discs, field, samples, radius, rays, !scene.tuned});
  return all;
}

}  // namespace detp::study
