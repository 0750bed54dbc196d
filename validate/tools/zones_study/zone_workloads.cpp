#include "zone_workloads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "detp/sim/geometry/random.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/scene/families/families.hpp"

namespace detp::zones {
namespace {

constexpr double least_rays = 100;
constexpr double most_rays = 409'600;
constexpr double most_hits = 2e7;
constexpr int surfaces_crossed = 4;  ///< by a ray, to estimate hits
constexpr int workloads_of_region = 3;

struct Region {
  double from, to;
};
constexpr std::array regions{Region{least_x, index_up_to}, Region{index_up_to, cache_from}, Region{cache_from, most_x}};

double log_uniform(double from, double to, double random) { return from * std::pow(to / from, random); }

std::vector<std::string> scenes_in(const std::string& folder, std::uint64_t seed) {
  std::vector<std::string> all{"@tree", "@tree-coarse", "@courtyard", "@cornell", "@interior"};
  for (const sim::families::Family& family : sim::families::all_families())
    all.push_back(fmt::format("@{}:{}", family.name, seed));
  if (!folder.empty())
    for (const char* mesh : {"sponza.ply", "stanford_bunny.obj"}) all.push_back(folder + "/" + mesh);
  return all;
}

}  // namespace

std::vector<ZoneWorkload> zone_workloads(const std::string& folder, std::uint64_t seed) {
  std::vector<ZoneWorkload> workloads;
  for (const std::string& scene : scenes_in(folder, seed))
    for (const Region& region : regions)
      for (int i = 0; i < workloads_of_region; ++i) {
        const auto random = sim::uniform4(seed, sim::Stream::scene, workloads.size());
        const double x = log_uniform(region.from, region.to, random[0]);
        const double hits_of_ray = surfaces_crossed * std::numbers::pi / (x * x);
        const double rays = log_uniform(least_rays, std::min(most_rays, most_hits / hits_of_ray), random[1]);
        const sim::Field field = i + 1 < workloads_of_region ? sim::Field::photons : sim::Field::isotropic;
        workloads.push_back({std::filesystem::path(scene).stem().string(), scene, field, x, std::round(rays)});
      }
  return workloads;
}

validate::Job make_zone_job(const ZoneWorkload& workload) {
  validate::JobRequest request;
  request.scene = workload.scene;
  request.field = workload.field;
  request.rays = std::min(workload.rays, 1000.0);
  const double distance = sample_distance(validate::make_job(request).workload());
  request.rays = workload.rays;
  request.disc_radius = validate::Length{distance / workload.x, false};
  return validate::make_job(request);
}

}  // namespace detp::zones
