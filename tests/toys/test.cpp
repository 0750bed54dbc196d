#include <algorithm>
#include <cstdio>
#include <fstream>

#include "detp/model/rank/choose.hpp"
#include "detp/sim/effects/all_effects.hpp"
#include "detp/sim/estimate/estimate.hpp"
#include "detp/sim/files/mesh_file.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"

using namespace detp;

/// Whether the new technique is known by its name, finds the hits of brute force and is ranked.
bool technique_works() {
  const auto discs = sim::uniform_discs(sim::Body::cube, 2, 500, 0.05, 1);
  const auto rays = sim::LineField(sim::enclosing_sphere(discs), 1).lines(0, 3000);
  const sim::Problem problem = sim::make_problem({rays}, discs);
  Candidate toy = default_candidate(technique_named("each-pair").value());
  set_parameter(toy, "step", std::int64_t{3});
  const sim::Outcome found = sim::run(problem, toy);
  const sim::Outcome expected = sim::run(problem, default_candidate(Technique::brute_force));
  const Workload workload = cube_workload(3000, 500, 0.05, 2);
  const auto ranking = model::rank(workload, CostTable{});
  const bool ranked =
      std::ranges::any_of(ranking, [&](const Prediction& one) { return one.candidate.technique == toy.technique; });
  std::printf("%s: hits %llu, expected %llu, %s\n", title(toy).c_str(),
              static_cast<unsigned long long>(found.counts.hits), static_cast<unsigned long long>(expected.counts.hits),
              ranked ? "ranked" : "not ranked");
  return ranked && found.counts.hits > 0 && found.counts.hits == expected.counts.hits &&
         found.counts.disc_tests == 500 * 3000;
}

/// Whether the new estimator is known by its name and does what its file says, on the new scene.
bool estimator_and_scene_work() {
  const sim::Scene scene = sim::open_scene({.name = "@square"});
  std::vector<sim::Disc> discs;
  for (const sim::Sample& sample : scene.samples) discs.push_back({sample.position, sample.normal, 0.1});
  sim::Paths paths;
  paths.rays.push_back({.origin = {0.3, 1, -0.2}, .direction = {0, -1, 0}, .length = 1.0001, .power = 2});
  paths.triangles.push_back(0);
  const sim::Problem problem = sim::make_problem(paths, discs);
  const auto irradiance = [&](std::string_view name) {
    const auto* record = std::ranges::find(sim::estimators, name, &sim::EstimatorRecord::name);
    return sim::estimate(problem, {.estimator = record->estimator, .mesh = &scene.mesh}).irradiance;
  };
  return scene.samples.size() == 4 && irradiance("toy-hits") == irradiance("triangle-hits");
}

bool effect_works() {
  return std::ranges::any_of(sim::all_effects, [](const sim::Effect* effect) {
    return effect->name == std::string_view("few rays") && effect->of_numbers(cube_workload(10, 500, 0.05, 2)) == 1;
  });
}

bool format_works() {
  std::ofstream("toy.corners") << "0 0 0 1 0 0 0 1 0";
  sim::Notices notices;
  return sim::read_mesh("toy.corners", notices).triangles.size() == 1 &&
         sim::mesh_suffixes() == ".obj, .ply, .stl, .gltf, .glb or .corners";
}

/// Returns 0 if all that was added works.
int main() {
  const bool technique = technique_works();
  const bool estimator = estimator_and_scene_work();
  const bool effect = effect_works();
  const bool format = format_works();
  std::printf("technique %d, estimator and scene %d, effect %d, format %d\n", technique, estimator, effect, format);
  return technique && estimator && effect && format ? 0 : 1;
}
