// Is the sphere cache fastest at the Q and k that the model chooses? Times it beside many other (Q, k).
//
//   cmake --build build --target best_ratio && build/best_ratio [FOLDER OF MESHES] > best_ratio.csv
//
// For each workload and engine: Q and k of model::best_ratio_and_stop with the unit costs of this machine
// (`detp calibrate`), and its seconds over those of the fastest (Q, k) of a grid: Q from 0.2 to 0.92, each with three
// numbers of spheres around its best. The fastest is selected on one half of the runs, and judged on the other. The
// plateau is the range of Q whose fastest k takes at most 5 % longer than the fastest of all; `noise` is the fastest,
// timed as if it were another candidate, over itself. One thread; some 10 minutes.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "detp/model/optimum/best_ratio.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "detp/validate/job/job.hpp"
#include "detp/validate/regret/exhaustive.hpp"
#include "detp/validate/regret/timed_rounds.hpp"
#include "detp/validate/statistics/statistics.hpp"

namespace {

using namespace detp;
using validate::Timed;

constexpr double least_ratio = 0.2;
constexpr double step = 0.04;
constexpr int ratios = 19;
constexpr double plateau = 1.05;

struct Setting {
  std::string scene;
  double samples, rays, radius;
  sim::Field field;
};

std::vector<Setting> settings(const std::string& folder) {
  std::vector<Setting> all;
  for (const double radius : {0.005, 0.02})
    for (const double rays : {1e3, 1e4}) {
      all.push_back({"@uniform", 1e4, rays, radius, sim::Field::isotropic});
      all.push_back({"@tree", 1e4, rays, radius, sim::Field::photons});
      if (folder.empty()) continue;
      all.push_back({folder + "/stanford_bunny.obj", 1e4, rays, radius, sim::Field::isotropic});
      all.push_back({folder + "/sponza.ply", 1e4, rays, radius, sim::Field::photons});
    }
  return all;
}

Candidate cache(double ratio, std::int64_t spheres) {
  return {Technique::sphere_cache, SphereCacheParameters{ratio, spheres}};
}

const SphereCacheParameters& parameters_of(const Timed& one) {
  return std::get<SphereCacheParameters>(one.contender.candidate.parameters);
}

void time_all(const sim::Problem& problem, Engine engine, std::vector<Timed>& all, std::vector<double> Timed::*half) {
  const auto times = validate::timed_rounds(
      all.size(), {.rounds = 9, .behind = 1.2, .most_seconds = 10}, [&](std::size_t i) -> std::optional<double> {
        return sim::run(problem, all[i].contender.candidate, {.count = false, .engine = engine}).seconds.total();
      });
  for (std::size_t i = 0; i < all.size(); ++i) all[i].*half = times[i];
}

void compare(const Setting& setting, const validate::Job& job, const sim::Problem& problem, const CostTable& table) {
  const UnitCosts& costs = table[Technique::sphere_cache];
  const Engine engine = table.engine;
  const model::BestRatio chosen = model::best_ratio_and_stop(job.workload(), costs);
  if (chosen.spheres == 0) return;
  std::vector<Timed> all{{.contender = {cache(chosen.ratio, chosen.spheres)}}};
  for (int i = 0; i < ratios; ++i) {
    const double ratio = least_ratio + step * i;
    const std::int64_t best = model::best_stop(job.workload(), costs, {ratio}).spheres;
    for (const std::int64_t spheres : {best - 1, best, best + 1})
      if (spheres >= 1) all.push_back({.contender = {cache(ratio, spheres)}});
  }
  time_all(problem, engine, all, &Timed::selecting);
  const Timed fastest = all[*validate::fastest_selected(all)];
  double low = parameters_of(fastest).ratio;
  double high = low;
  for (const Timed& one : all)
    if (validate::median_ratio(one.selecting, fastest.selecting) <= plateau) {
      low = std::min(low, parameters_of(one).ratio);
      high = std::max(high, parameters_of(one).ratio);
    }
  std::vector<Timed> judged{all.front(), fastest, fastest};
  time_all(problem, engine, judged, &Timed::judging);
  const SphereCacheParameters& best = parameters_of(fastest);
  fmt::print("{},{},{},{:.0f},{:.0f},{:.5g},{:.3f},{},{:.3f},{},{:.4g},{:.3f},{:.3f},{:.3f},{:.3f}\n",
             std::filesystem::path(setting.scene).stem().string(),
             setting.field == sim::Field::photons ? "photons" : "isotropic", name(engine), job.given.rays,
             job.given.samples, job.given.disc_radius, chosen.ratio, chosen.spheres, best.ratio, best.spheres,
             judged[1].judging_seconds(), judged[0].judged_ratio(judged[1]), judged[2].judged_ratio(judged[1]), low,
             high);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const std::array costs{validate::stored_unit_costs(Engine::simd), validate::stored_unit_costs(Engine::plain)};
  fmt::print(
      "scene,field,engine,rays,samples,disc_radius,chosen_ratio,chosen_spheres,best_ratio,best_spheres,"
      "best_seconds,chosen_over_best,noise,plateau_low,plateau_high\n");
  for (const Setting& setting : settings(argc > 1 ? argv[1] : "")) {
    validate::JobRequest request;
    request.scene = setting.scene;
    request.rays = setting.rays;
    request.samples = setting.samples;
    request.disc_radius = validate::Length{setting.radius, true};
    request.field = setting.field;
    const validate::Job job = validate::make_job(request);
    const sim::Problem& problem = job.problem();
    for (const CostTable& table : costs) compare(setting, job, problem, table);
  }
}
