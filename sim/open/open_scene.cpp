#include "open_scene.hpp"

#include <fmt/format.h>

#include <charconv>
#include <stdexcept>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/files/file_error.hpp"
#include "detp/sim/files/mesh_file.hpp"
#include "detp/sim/photons/emitter.hpp"
#include "detp/sim/photons/placed_lights.hpp"
#include "detp/sim/scene/built_in/built_in.hpp"
#include "detp/sim/scene/coincident.hpp"
#include "detp/sim/scene/families/families.hpp"
#include "detp/sim/scene/resample.hpp"

namespace detp::sim {
namespace {

constexpr std::size_t default_uniform_samples = 100'000;

/// The scene "@room:7" of a family; nothing if no family has the name.
std::optional<built_in::LitMesh> scene_of_family(const std::string& name) {
  for (const families::Family& family : families::all_families) {
    const std::string prefix = fmt::format("@{}:", family.name);
    if (!name.starts_with(prefix)) continue;
    const std::string_view digits = std::string_view(name).substr(prefix.size());
    std::uint64_t seed = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), seed);
    if (error != std::errc() || end != digits.data() + digits.size())
      throw std::invalid_argument(
          fmt::format("the scene {} needs a whole number as seed, as in {}7", shortened(name), prefix));
    return family.make(seed);
  }
  return std::nullopt;
}

const built_in::BuiltIn& built_in_named(const std::string& name) {
  std::vector<std::string_view> names;
  for (const built_in::BuiltIn& scene : built_in::built_ins) {
    if (scene.name == name) return scene;
    names.push_back(scene.name);
  }
  throw std::invalid_argument("there is no built-in scene " + shortened(name) + "; known scenes are " +
                              built_in_scenes() + did_you_mean(name, names));
}

Box box_of(const Scene& scene) {
  Box box = used_box(scene.mesh);
  for (const Sample& sample : scene.samples) box.include(sample.position);
  return box;
}

/// Adds the samples to a scene that already has its mesh and name.
void add_samples(Scene& scene, const SceneRequest& request, const std::stop_token& stop) {
  note_unreferenced(scene.mesh, scene.notices);
  join_coincident(scene.mesh, scene.notices, stop);
  scene.samples = samples_at_vertices(scene.mesh, request.crease, scene.notices, stop);
  if (scene.samples.empty())
    throw FileError(request.name, "no vertex has a normal; irradiance needs triangles with an area");
  const std::size_t wanted = request.samples.value_or(scene.samples.size());
  if (wanted < scene.samples.size()) scene.samples = random_subset(scene.samples, wanted, request.seed, stop);
  if (wanted > scene.samples.size())
    add_by_area(scene.samples, scene.mesh, wanted - scene.samples.size(), request.seed, stop);
  if (scene.samples.size() < wanted)
    throw FileError(request.name, "its triangles have no area, so that only its " +
                                      std::to_string(scene.samples.size()) + " vertices can be samples (" +
                                      std::to_string(wanted) + " asked for)");
}

/// Adds the lights that are requested, in place of the scene's own; if it has none at all, an area light.
void add_lights(Scene& scene, const SceneRequest& request, const Up& up, const std::stop_token& stop) {
  std::vector<LightKind> kinds = request.lights;
  if (kinds.empty() && scene.lights.empty()) kinds = {LightKind::area};
  scene.lights_placed = !kinds.empty();
  if (scene.lights_placed) scene.lights = placed_lights(kinds, scene.mesh, scene.box, up, stop);
  scene.up = up;
}

Scene uniform_scene(const SceneRequest& request, const std::stop_token& stop) {
  Scene scene;
  scene.name = request.name;
  scene.samples = built_in::uniform_samples(request.samples.value_or(default_uniform_samples), request.seed, stop);
  // a fixed cube, not the box of the samples, so that 1 % of it is 0.02 for any number of samples
  scene.box = {glm::dvec3(-1), glm::dvec3(1)};
  scene.field = Field::isotropic;
  return scene;
}

Scene built_in_scene(const SceneRequest& request, const std::stop_token& stop) {
  std::optional<built_in::LitMesh> made = scene_of_family(request.name);
  if (!made) {
    const built_in::BuiltIn& known = built_in_named(request.name);
    if (known.make == nullptr) return uniform_scene(request, stop);
    made = known.make();
  }
  built_in::LitMesh lit_mesh = std::move(*made);
  Scene scene;
  scene.name = request.name;
  scene.mesh = std::move(lit_mesh.mesh);
  if (scene.rgb = request.rgb; scene.rgb) scene.mesh.materials.take_largest();
  scene.lights = std::move(lit_mesh.lights);
  if (request.lights.empty()) scene.known_irradiance = lit_mesh.known_irradiance;
  add_samples(scene, request, stop);
  scene.notices.clear();  // they are about files
  scene.box = box_of(scene);
  add_lights(scene, request, request.up.value_or(Up{}), stop);
  return scene;
}

Scene mesh_scene(const SceneRequest& request, const std::stop_token& stop) {
  Scene scene;
  scene.name = request.name;
  scene.mesh = read_mesh(request.name, scene.notices, stop);
  if (scene.rgb = request.rgb; scene.rgb) scene.mesh.materials.take_largest();
  add_samples(scene, request, stop);
  scene.box = box_of(scene);
  if (scene.box.low == scene.box.high) return scene;
  if (emitted_flux(scene.mesh) > 0) scene.lights = {{SurfaceLight{}, emitted_flux(scene.mesh)}};
  const bool needs_up = scene.lights.empty() || !request.lights.empty();
  const Up up = request.up ? *request.up : needs_up ? up_of(scene.mesh, scene.box, stop) : Up{};
  add_lights(scene, request, up, stop);
  return scene;
}

}  // namespace

std::string built_in_scenes() {
  std::string known;
  for (const built_in::BuiltIn& scene : built_in::built_ins)
    known += fmt::format("{}{}", known.empty() ? "" : ", ", scene.name);
  for (const families::Family& family : families::all_families) known += fmt::format(", @{}:SEED", family.name);
  return known;
}

Scene open_scene(const SceneRequest& request, const std::stop_token& stop) {
  const DefaultFloatingPoint mode;
  if (request.samples == std::size_t{0}) throw std::invalid_argument("a scene needs at least 1 sample (got 0)");
  return request.name.starts_with('@') ? built_in_scene(request, stop) : mesh_scene(request, stop);
}

}  // namespace detp::sim
