#include "measure.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "detp/sim/base/radix_sort.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/lebesgue.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/geometry/ray_box.hpp"

namespace detp::validate {
namespace {

sim::Box box_of_centres(std::span<const sim::Disc> discs, sim::StopCheck& check) {
  sim::Box box;
  sim::for_each_checked(discs, check, [&](const sim::Disc& disc) { box.include(disc.centre); });
  return box;
}

std::vector<std::size_t> sample_of(std::size_t size, std::size_t most) {
  return sim::stratified_sample(size, most, 1, sim::Stream::evidence);
}

/// Number of cells that the sampled discs occupy after each number of halvings, 0 … 16.
std::vector<double> occupied_cells(std::span<const sim::Disc> discs, const std::vector<std::size_t>& sample,
                                   const std::stop_token& stop) {
  sim::StopCheck check(stop, "measuring the samples");
  const sim::Box box = box_of_centres(discs, check);
  std::vector<sim::KeyedIndex> codes;
  codes.reserve(sample.size());
  sim::for_each_checked(std::span(sample), check, [&](std::size_t disc) {
    codes.push_back({sim::lebesgue_code(discs[disc].centre, box), 0});
  });
  sim::radix_sort(codes, 48, stop);
  std::vector<double> occupied;
  for (int level = 0; level <= 16; ++level) {
    const int shift = 48 - 3 * level;
    double cells = 1;
    sim::for_each_checked(1, codes.size(), check,
                          [&](std::size_t i) { cells += codes[i].key >> shift != codes[i - 1].key >> shift ? 1 : 0; });
    occupied.push_back(cells);
  }
  return occupied;
}

/// Mean length of the rays inside the grown box; 0 if all rays are unbounded lines.
double mean_path_length(const sim::Problem& problem, const sim::Box& box, double disc_radius,
                        const std::stop_token& stop) {
  sim::StopCheck check(stop, "measuring the rays");
  const sim::Box grown{box.low - disc_radius, box.high + disc_radius};
  if (!problem.segments()) return 0;
  double sum = 0;
  const std::vector<std::size_t> sample = sample_of(problem.rays().size(), 1U << 14);
  sim::for_each_checked(std::span(sample), check, [&](std::size_t ray) {
    const sim::RayInterval inside = sim::ClippedRay(problem.rays()[ray]).inside(grown);
    if (!inside.empty()) sum += inside.to - inside.from;
  });
  return sum / static_cast<double>(sample.size());
}

/// Root mean square radius. If all radii are equal, the result is exactly this radius.
double rms_radius(std::span<const sim::Disc> discs, sim::StopCheck& check) {
  double sum = 0;
  bool same = true;
  sim::for_each_checked(discs, check, [&](const sim::Disc& disc) {
    sum += disc.radius * disc.radius;
    same = same && disc.radius == discs.front().radius;
  });
  return same ? discs.front().radius : std::sqrt(sum / static_cast<double>(discs.size()));
}

}  // namespace

double sample_dimension(std::span<const sim::Disc> discs, const std::stop_token& stop) {
  constexpr double least_points = 4096;
  constexpr double points_per_cell = 4;
  constexpr int levels = 3;
  const std::vector<std::size_t> sample = sample_of(discs.size(), 1U << 17);
  const auto points = static_cast<double>(sample.size());
  if (points < least_points) return 3;
  const std::vector<double> occupied = occupied_cells(discs, sample, stop);
  int last = levels;
  while (last < 16 && occupied[static_cast<std::size_t>(last) + 1] * points_per_cell <= points) ++last;
  Eigen::Matrix<double, levels, 2> line;
  Eigen::Matrix<double, levels, 1> logs;
  for (int i = 0; i < levels; ++i) {
    line.row(i) << 1, i;
    logs[i] = std::log2(occupied[static_cast<std::size_t>(last - levels + 1 + i)]);
  }
  const Eigen::Vector2d fit = line.colPivHouseholderQr().solve(logs);
  return std::clamp(fit[1], 1.0, 3.0);
}

Workload measure(const sim::Problem& problem, const SurfaceFacts& surface, const std::stop_token& stop) {
  sim::StopCheck check(stop, "measuring the samples");
  const sim::Box box = box_of_centres(problem.discs(), check);
  const glm::dvec3 size = box.size();
  const double radius = rms_radius(problem.discs(), check);
  Workload workload{.rays = static_cast<double>(problem.rays().size()),
                    .samples = static_cast<double>(problem.discs().size()),
                    .disc_radius = radius,
                    .sphere_radius = problem.enclosing().radius,
                    .box = {size.x, size.y, size.z},
                    .dimension = sample_dimension(problem.discs(), stop),
                    .sample_distance = surface.edge_length,
                    .path_length = mean_path_length(problem, box, radius, stop),
                    .front_facing = problem.front_facing()};
  // If all samples are at one point, their box has no size. Then uses a cube with the discs' diameter as side.
  if (!(scene_side(workload) > 0)) workload.box.fill(2 * workload.disc_radius);
  // Computed from the samples' own box, because samples need not fill the scene's box.
  workload.sample_extent = sample_extent(workload);
  if (surface.area > 0) {
    const double weight = std::clamp(workload.dimension - 2, 0.0, 1.0);
    Workload volume = workload;
    volume.dimension = 3;
    volume.sample_extent = 0;
    workload.sample_extent = std::pow(sample_extent(volume), weight) * std::pow(surface.area, 1 - weight);
  }
  return workload;
}

}  // namespace detp::validate
