#include "regret_workloads.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/scene/families/families.hpp"

namespace detp::validate {
namespace {

constexpr std::size_t strays = 5;
constexpr double stray_distance = 300;
constexpr std::uint64_t clusters = 20;

std::array<double, 4> uniform(std::uint64_t seed, std::uint64_t number, std::uint64_t use) {
  return sim::uniform4(seed, sim::Stream::tests, number, use);
}

/// Two independent standard normal numbers (Box and Muller).
std::array<double, 2> normal(double u, double v) {
  const double length = std::sqrt(-2 * std::log1p(-u));
  return {length * std::cos(2 * std::numbers::pi * v), length * std::sin(2 * std::numbers::pi * v)};
}

glm::dvec3 in_cube(std::uint64_t seed, std::uint64_t number) {
  const auto u = uniform(seed, number, 0);
  return {u[0] - 0.5, u[1] - 0.5, u[2] - 0.5};
}

/// The sizes of the clusters fall geometrically from 0.1 to 0.0003.
glm::dvec3 in_cluster(std::uint64_t seed, std::uint64_t number) {
  const std::uint64_t cluster = number % clusters;
  const double size = 0.1 * std::pow(0.003, static_cast<double>(cluster) / (clusters - 1));
  const auto u = uniform(seed, number, 0);
  const auto xy = normal(u[0], u[1]);
  const auto z = normal(u[2], u[3]);
  return 0.8 * in_cube(seed, cluster) + size * glm::dvec3(xy[0], xy[1], z[0]);
}

glm::dvec3 on_floor_or_ball(std::uint64_t seed, std::uint64_t number) {
  constexpr double radius = 0.005;
  const auto u = uniform(seed, number, 0);
  if (number % 2 == 0) return {u[0] - 0.5, 0, u[1] - 0.5};
  return glm::dvec3(0.1, radius, 0.2) + radius * sim::uniform_direction(u[0], u[1]);
}

glm::dvec3 position(AwkwardScene scene, std::uint64_t seed, std::uint64_t number) {
  switch (scene) {
    case AwkwardScene::clusters:
      return in_cluster(seed, number);
    case AwkwardScene::tiny_object:
      return on_floor_or_ball(seed, number);
    case AwkwardScene::thin_sheet:
      return in_cube(seed, number) * glm::dvec3(1, 0, 1);
    case AwkwardScene::strays:
      return in_cube(seed, number) * (number < strays ? 2 * stray_distance : 1.0);
    case AwkwardScene::mixed_radii:
      break;
  }
  return in_cube(seed, number);
}

constexpr std::array radii{0.0025, 0.01, 0.04, 0.16};
constexpr std::array ray_counts{1e2, 1e3, 1e4, 1e5, 1e6};
constexpr std::array meshes{"stanford_bunny.obj", "sponza.ply", "bedroom.ply", "mountain.obj", "grove_fine.ply"};
constexpr double most_hits = 3e7;        ///< expected if the discs are spread out
constexpr double usual_vertices = 1e5;   ///< order of magnitude, of scenes with a sample for each vertex
constexpr std::size_t quick_stride = 3;  ///< the quick effort takes every third workload

struct Scene {
  std::string name;
  std::variant<std::string, AwkwardScene> discs;
  bool light = false;
  std::vector<double> samples = {0};
  bool held_out = false;
};

Scene awkward(AwkwardScene scene, std::vector<double> samples, bool held_out) {
  return {std::string(name(scene)), scene, false, std::move(samples), held_out};
}

std::vector<Scene> scenes_of(RegretEffort effort, const std::string& folder, std::vector<std::string>& missing) {
  const bool all = effort == RegretEffort::thorough;
  const std::vector<double> vertices = all ? std::vector{0.0} : std::vector{1e4};
  const std::vector<double> many = all ? std::vector{1e4, 1e5} : std::vector{1e4};
  std::vector<Scene> scenes{
      {"@uniform", "@uniform", false, all ? std::vector{1e2, 1e3, 1e4, 1e5, 1e6} : std::vector{1e3, 1e4}},
      {"@tree", "@tree", true, vertices},
      {"@courtyard", "@courtyard", true, vertices},
      awkward(AwkwardScene::clusters, many, false),
      awkward(AwkwardScene::strays, {1e4}, false),
      {"@cornell", "@cornell", true, vertices, true},
      awkward(AwkwardScene::tiny_object, many, true),
      awkward(AwkwardScene::thin_sheet, {1e4}, true),
      awkward(AwkwardScene::mixed_radii, {1e4}, true)};
  if (!all) return scenes;
  for (const std::filesystem::path mesh : meshes) {
    const std::string stem = mesh.stem().string();
    if (folder.empty())
      missing.push_back(stem + ": DETP_SCENES, the folder of its file, is not set");
    else if (!std::filesystem::exists(folder / mesh))
      missing.push_back(stem + ": " + (folder / mesh).string() + " does not exist");
    else
      scenes.push_back({stem, (folder / mesh).string(), true, {0}, true});
  }
  return scenes;
}

bool is_in(RegretEffort effort, const RegretWorkload& one, std::size_t place) {
  if (effort == RegretEffort::quick && (one.rays > 1e4 || one.rays < 1e3 || place % quick_stride != 0)) return false;
  const double samples = one.samples > 0 ? one.samples : usual_vertices;
  if (one.rays * samples * one.radius * one.radius > most_hits) return false;
  return one.rays < 1e6 || one.radius < 0.02;
}

/// The effort of evidence that `choose` takes.
Job with_effort(Job job) {
  job.measuring.effort = sim::EvidenceEffort::for_search(job.given.rays, job.given.samples);
  return job;
}

}  // namespace

std::string_view name(AwkwardScene scene) {
  constexpr std::array<std::string_view, 5> names{"clusters", "tiny-object", "thin-sheet", "strays", "mixed-radii"};
  return names[static_cast<std::size_t>(scene)];
}

std::vector<sim::Disc> awkward_discs(AwkwardScene scene, std::size_t count, double radius, std::uint64_t seed) {
  std::vector<sim::Disc> discs;
  discs.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto u = uniform(seed, i, 1);
    const double factor = scene == AwkwardScene::mixed_radii ? std::exp(normal(u[2], u[3])[0]) : 1;
    discs.push_back({position(scene, seed, i), sim::uniform_direction(u[0], u[1]), radius * factor});
  }
  return discs;
}

RegretSet regret_set(RegretEffort effort, const std::string& folder) {
  RegretSet set;
  std::size_t place = 0;
  for (const Scene& scene : scenes_of(effort, folder, set.missing))
    for (const double samples : scene.samples)
      for (const sim::Field field : {sim::Field::isotropic, sim::Field::photons})
        for (const double radius : radii)
          for (const double rays : ray_counts) {
            if (field == sim::Field::photons && !scene.light) continue;
            const RegretWorkload one{scene.name, scene.discs, field, samples, radius, rays, scene.held_out};
            if (is_in(effort, one, place++)) set.workloads.push_back(one);
          }
  return set;
}

std::vector<RegretWorkload> family_workloads(std::uint64_t seed) {
  constexpr int scenes_of_family = 2;
  constexpr int workloads_of_scene = 7;
  constexpr int photons_of_scene = 5;
  std::vector<RegretWorkload> workloads;
  std::uint64_t place = 0;
  for (const sim::families::Family& family : sim::families::all_families())
    for (int scene = 0; scene < scenes_of_family; ++scene)
      for (int i = 0; i < workloads_of_scene; ++i) {
        const std::string name = fmt::format("@{}:{}", family.name, 100 * seed + static_cast<std::uint64_t>(scene));
        const sim::Field field = i < photons_of_scene ? sim::Field::photons : sim::Field::isotropic;
        const auto random = sim::uniform4(seed, sim::Stream::scene, place++);
        const double radius = radii.front() * std::pow(radii.back() / radii.front(), random[0]);
        const double most_rays = std::min(ray_counts.back(), most_hits / (usual_vertices * radius * radius));
        const double rays = std::round(ray_counts.front() * std::pow(most_rays / ray_counts.front(), random[1]));
        workloads.push_back({name, name, field, 0, radius, rays, true});
      }
  return workloads;
}

Job make_regret_job(const RegretWorkload& workload, std::uint64_t seed, const std::stop_token& stop) {
  if (const auto* path = std::get_if<std::string>(&workload.discs)) {
    JobRequest request;
    request.scene = *path;
    request.field = workload.field;
    if (workload.samples > 0) request.samples = workload.samples;
    request.disc_radius = Length{workload.radius, true};
    request.rays = workload.rays;
    request.seed = seed;
    request.effects = workload.effects;
    return with_effort(make_job(request, stop));
  }
  Job job;
  job.name = workload.scene;
  job.discs = awkward_discs(std::get<AwkwardScene>(workload.discs), static_cast<std::size_t>(workload.samples),
                            workload.radius, seed);
  job.rays = sim::LineField(sim::enclosing_sphere(job.discs, stop), seed)
                 .lines(0, static_cast<std::size_t>(workload.rays), stop);
  job.check_problem(1, stop);
  job.measuring = {.effects = workload.effects, .stop = stop};
  return with_effort(std::move(job));
}

}  // namespace detp::validate
