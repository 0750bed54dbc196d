#include "regret_workloads.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "detp/sim/rays/line_field.hpp"
#include "detp/validate/choice/measure.hpp"

namespace detp::validate {
namespace {

constexpr std::array radii{0.0025, 0.01, 0.04, 0.16};
constexpr std::array rays{1e2, 1e3, 1e4, 1e5, 1e6};
constexpr double most_hits = 3e7;  // expected for spread-out discs

struct Scene {
  std::string name;
  std::variant<std::string, AwkwardScene> discs;
  bool light = false;
  std::vector<double> samples = {0};
  bool held_out = false;
};

std::vector<Scene> all_scenes(RegretEffort effort, const std::string& folder) {
  const bool all = effort == RegretEffort::thorough;
  std::vector<Scene> scenes{
      {"@uniform", "@uniform", false, all ? std::vector{1e2, 1e3, 1e4, 1e5, 1e6} : std::vector{1e3, 1e4}},
      {"@tree", "@tree", true, all ? std::vector{0.0} : std::vector{1e4}},
      {"@courtyard", "@courtyard", true, all ? std::vector{0.0} : std::vector{1e4}},
      {"clusters", AwkwardScene::clusters, false, all ? std::vector{1e4, 1e5} : std::vector{1e4}},
      {"strays", AwkwardScene::strays, false, {1e4}},
      {"@cornell", "@cornell", true, all ? std::vector{0.0} : std::vector{1e4}, true},
      {"tiny object", AwkwardScene::tiny_object, false, all ? std::vector{1e4, 1e5} : std::vector{1e4}, true},
      {"thin sheet", AwkwardScene::thin_sheet, false, {1e4}, true},
      {"mixed radii", AwkwardScene::mixed_radii, false, {1e4}, true}};
  for (const char* mesh : {"stanford_bunny.obj", "sponza.ply", "bedroom.ply", "mountain.obj", "grove_fine.ply"})
    if (all && !folder.empty() && std::filesystem::exists(std::filesystem::path(folder) / mesh))
      scenes.push_back({std::filesystem::path(mesh).stem().string(),
                        (std::filesystem::path(folder) / mesh).string(),
                        true,
                        {0},
                        true});
  return scenes;
}

/// Whether the workload belongs to the set: the fields alternate, and 10⁶ rays only meet small discs.
bool is_wanted(RegretEffort effort, const RegretWorkload& one, std::size_t place) {
  if (effort == RegretEffort::small && (one.rays > 1e4 || one.rays < 1e3 || place % 3 != 0)) return false;
  const double samples = one.samples > 0 ? one.samples : 1e5;
  if (one.rays * samples * one.radius * one.radius > most_hits) return false;
  return one.rays < 1e6 || one.radius < 0.02;
}

}  // namespace

std::vector<RegretWorkload> regret_workloads(RegretEffort effort, const std::string& folder) {
  std::vector<RegretWorkload> workloads;
  std::size_t place = 0;
  for (const Scene& scene : all_scenes(effort, folder))
    for (const double samples : scene.samples)
      for (const sim::Field field : {sim::Field::isotropic, sim::Field::photons})
        for (const double radius : radii)
          for (const double count : rays) {
            if (field == sim::Field::photons && !scene.light) continue;
            const RegretWorkload one{scene.name, scene.discs, field, samples, radius, count, scene.held_out};
            if (is_wanted(effort, one, place++)) workloads.push_back(one);
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
    return make_job(request, stop);
  }
  Job job;
  job.name = workload.scene;
  job.discs = awkward_discs(std::get<AwkwardScene>(workload.discs), static_cast<std::size_t>(workload.samples),
                            workload.radius, seed);
  job.rays = sim::LineField(sim::enclosing_sphere(job.discs, stop), seed)
                 .lines(0, static_cast<std::size_t>(workload.rays), stop);
  job.workload = measure(job.problem(1, stop), {}, stop);
  return job;
}

}  // namespace detp::validate
