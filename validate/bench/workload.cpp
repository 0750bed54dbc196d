#include "workload.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/rays/line_field.hpp"

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

/// Roughly proportional to the time of the workload.
double effort(const BenchWorkload& workload) { return workload.rays + 3e4; }

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

std::string radius_text(const BenchWorkload& workload) {
  const Length& radius = workload.disc_radius;
  return radius.relative ? fmt::format("{:g}%", 100 * radius.value) : fmt::format("{:g}", radius.value);
}

std::string title_of(const BenchWorkload& workload) {
  return fmt::format("{}, {}, {:g} rays{}, radius {}", workload.scene, name(workload.field), workload.rays,
                     workload.samples ? fmt::format(", {:g} samples", *workload.samples) : "", radius_text(workload));
}

Job make_bench_job(const BenchWorkload& workload, std::uint64_t seed, const std::stop_token& stop,
                   const sim::ReportPhase& progress) {
  if (const auto* path = std::get_if<std::string>(&workload.discs)) {
    JobRequest request;
    request.scene = *path;
    request.field = workload.field;
    request.samples = workload.samples;
    request.disc_radius = workload.disc_radius;
    request.rays = workload.rays;
    request.seed = seed;
    request.effects = workload.effects;
    return make_job(request, stop, progress);
  }
  Job job;
  job.name = workload.scene;
  job.discs = awkward_discs(std::get<AwkwardScene>(workload.discs),
                            static_cast<std::size_t>(workload.samples.value_or(0)), workload.disc_radius.value, seed);
  job.rays = sim::LineField(sim::enclosing_sphere(job.discs, stop), seed)
                 .lines(0, static_cast<std::size_t>(workload.rays), stop);
  job.check_problem(1, stop);
  job.measuring = {.effects = workload.effects, .stop = stop};
  return job;
}

sim::ReportPhase titled(const sim::ReportPhase& progress, const std::string& title) {
  if (!progress) return {};
  return [progress, title](sim::Phase phase) {
    phase.what = fmt::format("{}: {}", title, phase.what);
    progress(phase);
  };
}

SetProgress run_each(std::span<const BenchWorkload> workloads, const RunWorkload& run, const std::stop_token& stop,
                     const sim::ReportPhase& progress) {
  SetProgress set{.workloads = workloads.size()};
  double left = std::accumulate(workloads.begin(), workloads.end(), 0.0,
                                [](double sum, const BenchWorkload& one) { return sum + effort(one); });
  double before = 0;
  for (std::size_t i = 0; i < workloads.size() && !stop.stop_requested(); ++i) {
    const double own = effort(workloads[i]);
    const double whole = before + left;
    try {
      const std::string why = run(i, sim::part_of(progress, before / whole, (before + own) / whole));
      ++set.done;
      if (why.empty())
        before += own;
      else
        set.skipped.push_back({workloads[i], why});
    } catch (const sim::Stopped&) {  // with less than its results
    }
    left -= own;
  }
  set.stopped = set.done < workloads.size();
  return set;
}

Json skipped_json(const SetProgress& set) {
  Json json = Json::array();
  for (const SkippedWorkload& one : set.skipped)
    json.push_back({{"workload", title_of(one.workload)}, {"why", one.why}});
  return json;
}

}  // namespace detp::validate
