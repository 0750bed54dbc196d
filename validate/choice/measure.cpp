#include "measure.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <vector>

#include "detp/sim/base/radix_sort.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/lebesgue.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/geometry/ray_box.hpp"
#include "far_discs.hpp"

namespace detp::validate {
namespace {

std::vector<std::size_t> sample_of(std::size_t size, std::size_t most) {
  return sim::stratified_sample(size, most, 1, sim::Stream::evidence);
}

/// Number of cells that the sampled discs occupy after each number of halvings, 0 … 16.
std::vector<double> occupied_cells(std::span<const sim::Disc> discs, const std::vector<std::size_t>& sample,
                                   const std::stop_token& stop) {
  sim::StopCheck check(stop, "measuring the samples");
  const sim::Box box = box_of_centres(discs, stop);
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

struct Paths {
  double share = 0;   ///< of the rays that have a part inside
  double length = 0;  ///< mean length of the part inside, over all rays
};

/// The rays inside the box grown by the disc radius.
Paths paths_inside(const sim::Problem& problem, const sim::Box& box, double disc_radius, const std::stop_token& stop) {
  sim::StopCheck check(stop, "measuring the rays");
  const sim::Box grown{box.low - disc_radius, box.high + disc_radius};
  Paths paths;
  const std::vector<std::size_t> sample = sample_of(problem.rays().size(), 1U << 14);
  const double each = 1 / static_cast<double>(sample.size());
  sim::for_each_checked(std::span(sample), check, [&](std::size_t ray) {
    const sim::RayInterval inside = sim::ClippedRay(problem.rays()[ray]).inside(grown);
    if (inside.empty()) return;
    paths.share += each;
    paths.length += each * (inside.to - inside.from);
  });
  return paths;
}

struct Radii {
  double rms = 0;  ///< if all radii are equal, exactly this radius
  double smallest = 0;
  double largest = 0;
};

Radii measure_radii(std::span<const sim::Disc> discs, sim::StopCheck& check) {
  double sum = 0;
  Radii radii{.smallest = discs.front().radius, .largest = discs.front().radius};
  sim::for_each_checked(discs, check, [&](const sim::Disc& disc) {
    sum += disc.radius * disc.radius;
    radii.smallest = std::min(radii.smallest, disc.radius);
    radii.largest = std::max(radii.largest, disc.radius);
  });
  radii.rms = radii.smallest == radii.largest ? radii.largest : std::sqrt(sum / static_cast<double>(discs.size()));
  return radii;
}

/// Classes of radii whose squares have the same binary exponent. The radii below 1/64 of the largest are one class.
std::vector<RadiusClass> radius_classes(std::span<const sim::Disc> discs, const Radii& radii, sim::StopCheck& check) {
  constexpr double about_equal = 1.1;
  if (radii.largest <= about_equal * radii.rms) return {};
  struct Sums {
    double discs = 0;
    double squares = 0;
  };
  const int highest = std::ilogb(radii.largest * radii.largest);
  constexpr int classes_apart = 12;
  const auto place_of = [&](double radius) {
    return static_cast<std::size_t>(std::min(highest - std::ilogb(radius * radius), classes_apart));
  };
  std::array<Sums, classes_apart + 1> sums;
  sim::for_each_checked(discs, check, [&](const sim::Disc& disc) {
    Sums& sum = sums[place_of(disc.radius)];
    sum.discs += 1;
    sum.squares += disc.radius * disc.radius;
  });
  const auto count = static_cast<double>(discs.size());
  std::vector<RadiusClass> classes;
  for (const Sums& sum : sums)
    if (sum.discs > 0) classes.push_back({std::sqrt(sum.squares / sum.discs), sum.discs / count});
  return classes;
}

/// The extent that the samples fill. Computed from the samples' own box, because samples need not fill the scene's box;
/// from the area of the surfaces if that is known.
double extent_of(Workload samples, double area) {
  if (!(area > 0)) return sample_extent(samples);
  const double weight = std::clamp(samples.dimension - 2, 0.0, 1.0);
  samples.dimension = 3;
  samples.sample_extent = 0;
  return std::pow(sample_extent(samples), weight) * std::pow(area, 1 - weight);
}

/// Lines are isotropic, so the share that crosses a sphere is known; that of segments is measured.
std::optional<CentralSamples> central_samples(const sim::Problem& problem, const sim::Box& whole, const Radii& radii,
                                              double area, const std::stop_token& stop) {
  const std::optional<FarDiscs> found = find_far_discs(problem.discs(), whole, stop);
  if (!found) return std::nullopt;
  sim::StopCheck check(stop, "measuring the samples");
  std::vector<sim::Disc> near;
  sim::for_each_checked(problem.discs(), check, [&](const sim::Disc& disc) {
    if (found->is_near(disc)) near.push_back(disc);
  });
  const sim::Box box = box_of_centres(near, stop);
  const glm::dvec3 size = box.size();
  CentralSamples central{.samples = static_cast<double>(near.size()),
                         .sphere_radius = glm::length(size) / 2 + radii.largest,
                         .box = {size.x, size.y, size.z},
                         .dimension = sample_dimension(near, stop)};
  if (!(longest_side(box) > 0)) central.box.fill(2 * radii.rms);
  central.sample_extent = extent_of({.box = central.box, .dimension = central.dimension}, area);
  if (problem.segments()) {
    const Paths paths = paths_inside(problem, box, radii.rms, stop);
    central.ray_share = std::min(1.0, paths.share);
    central.path_length = paths.share > 0 ? paths.length / paths.share : central.sphere_radius;
  } else {
    const double ratio = std::min(1.0, central.sphere_radius / problem.enclosing().radius);
    central.ray_share = ratio * ratio;
  }
  return central;
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
  const sim::Box box = box_of_centres(problem.discs(), stop);
  const glm::dvec3 size = box.size();
  const Radii radii = measure_radii(problem.discs(), check);
  Workload workload{.rays = static_cast<double>(problem.rays().size()),
                    .samples = static_cast<double>(problem.discs().size()),
                    .disc_radius = radii.rms,
                    .sphere_radius = problem.enclosing().radius,
                    .box = {size.x, size.y, size.z},
                    .dimension = sample_dimension(problem.discs(), stop),
                    .sample_distance = surface.edge_length,
                    .path_length = problem.segments() ? paths_inside(problem, box, radii.rms, stop).length : 0,
                    .front_facing = problem.front_facing(),
                    .radii = radius_classes(problem.discs(), radii, check),
                    .central = central_samples(problem, box, radii, surface.area, stop)};
  // If all samples are at one point, their box has no size. Then uses a cube with the discs' diameter as side.
  if (!(scene_side(workload) > 0)) workload.box.fill(2 * workload.disc_radius);
  workload.sample_extent = extent_of(workload, surface.area);
  return workload;
}

}  // namespace detp::validate
