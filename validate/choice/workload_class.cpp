#include "workload_class.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "detp/sim/geometry/random.hpp"

namespace detp::validate {
namespace {

int rounded(double value) { return static_cast<int>(std::lround(value)); }

template <class T>
std::vector<T> part_of(std::span<const T> all, std::size_t most) {
  std::vector<T> part;
  for (const std::size_t i : sim::stratified_sample(all.size(), most, 1, sim::Stream::evidence)) part.push_back(all[i]);
  return part;
}

}  // namespace

WorkloadClass class_of(const Valid<Workload>& workload) {
  WorkloadClass found{.rays = rounded(std::log2(workload.rays)),
                      .discs = rounded(std::log2(workload.samples)),
                      .spacing = rounded(2 * std::log2(sample_distance(workload) / workload.disc_radius)),
                      .dimension = rounded(4 * workload.dimension),
                      .path_length = WorkloadClass::lines,
                      .front_facing = workload.front_facing};
  if (workload.path_length > 0)
    found.path_length = std::min(rounded(std::log2(workload.path_length / scene_side(workload))), 90);
  return found;
}

std::string describe(const WorkloadClass& workload) {
  const std::string paths =
      workload.path_length == WorkloadClass::lines
          ? "lines"
          : fmt::format("mean length {:.3g} of the scene's side", std::exp2(workload.path_length));
  return fmt::format("about {:.3g} rays, {:.3g} discs, X = {:.2g}, D = {:.3g}, {}{}", std::exp2(workload.rays),
                     std::exp2(workload.discs), std::exp2(0.5 * workload.spacing), 0.25 * workload.dimension, paths,
                     workload.front_facing ? ", front facing" : "");
}

Workload sampled_workload(const sim::Problem& problem, std::span<const sim::Ray> like, double rays,
                          const sim::EffectSelection& effects, const std::stop_token& stop) {
  const std::vector<sim::Disc> discs = part_of(problem.discs(), 8192);
  const std::vector<sim::Ray> some = part_of(like, 1024);
  Workload workload =
      sim::observe(sim::make_problem(some, discs, problem.front_facing(), 1, stop), {}, effects, stop).workload;
  workload.rays = rays;
  workload.samples = static_cast<double>(problem.discs().size());
  workload.sphere_radius = problem.enclosing().radius;
  return workload;
}

}  // namespace detp::validate
