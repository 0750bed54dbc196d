#include "measure.hpp"

#include <algorithm>
#include <array>
#include <bit>
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

/// The cells that hold sampled points on one level.
struct Occupancy {
  double cells = 0;
  double once = 0;   ///< cells with one point
  double twice = 0;  ///< cells with two points

  /// Estimate of the cells that all points occupy: adds those in which the sample has none (Chao 1984).
  [[nodiscard]] double all_cells() const { return cells + once * (once - 1) / (2 * (twice + 1)); }
};

constexpr int finest_level = 16;
using Levels = std::array<Occupancy, finest_level + 1>;

/// The different places of the sampled discs on Lebesgue's curve, in its order, which is that of cells on every level.
std::vector<sim::KeyedIndex> places_of(std::span<const sim::Disc> discs, const std::vector<std::size_t>& sample,
                                       const std::stop_token& stop) {
  sim::Box box;
  for (const std::size_t disc : sample) box.include(discs[disc].centre);
  std::vector<sim::KeyedIndex> places;
  places.reserve(sample.size());
  for (const std::size_t disc : sample) places.push_back({sim::lebesgue_code(discs[disc].centre, box), 0});
  sim::radix_sort(places, 3 * finest_level, stop);
  const auto equal = [](const sim::KeyedIndex& a, const sim::KeyedIndex& b) { return a.key == b.key; };
  places.erase(std::unique(places.begin(), places.end(), equal), places.end());
  return places;
}

/// Counts cells by the level from which on neighbours in the order are in different cells.
Levels occupied_cells(const std::vector<sim::KeyedIndex>& places) {
  constexpr int never = 0;  // neighbours beyond both ends are apart on all levels
  std::vector<int> apart{never, never};
  for (std::size_t i = 1; i < places.size(); ++i)
    apart.push_back((std::countl_zero(places[i].key ^ places[i - 1].key) - (64 - 3 * finest_level)) / 3 + 1);
  apart.insert(apart.end(), {never, never});
  Levels levels;  // first the changes from level to level
  for (std::size_t i = 1; i + 2 < apart.size(); ++i) {
    const int alone = std::max(apart[i], apart[i + 1]);
    levels[static_cast<std::size_t>(apart[i])].cells += 1;
    levels[static_cast<std::size_t>(alone)].once += 1;
    const int two = std::max(apart[i - 1], apart[i + 1]);
    if (i == 1 || two >= apart[i]) continue;
    levels[static_cast<std::size_t>(two)].twice += 1;
    levels[static_cast<std::size_t>(apart[i])].twice -= 1;
  }
  for (std::size_t level = 1; level < levels.size(); ++level) {
    levels[level].cells += levels[level - 1].cells;
    levels[level].once += levels[level - 1].once;
    levels[level].twice += levels[level - 1].twice;
  }
  return levels;
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
  const std::vector<std::size_t> sample = sample_of(problem.rays().size(), 1U << 11);
  const double each = 1 / static_cast<double>(sample.size());
  sim::for_each_checked(std::span(sample), check, [&](std::size_t ray) {
    const sim::RayInterval inside = sim::ClippedRay(problem.rays()[ray]).inside(grown);
    if (inside.empty()) return;
    paths.share += each;
    paths.length += each * (inside.to - inside.from);
  });
  return paths;
}

/// Classes of radii whose squares have the same binary exponent. The radii below 1/64 of the largest are one class.
std::vector<RadiusClass> radius_classes(std::span<const sim::Disc> discs, const sim::DiscRadii& radii,
                                        sim::StopCheck& check) {
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
std::optional<CentralSamples> central_samples(const sim::Problem& problem, double area, const std::stop_token& stop) {
  const std::optional<FarDiscs> found = find_far_discs(problem, stop);
  if (!found) return std::nullopt;
  sim::StopCheck check(stop, "measuring the samples");
  const sim::DiscRadii& radii = problem.radii();
  std::vector<sim::Disc> near;
  sim::for_each_checked(problem.discs(), check, [&](const sim::Disc& disc) {
    if (found->is_near(disc)) near.push_back(disc);
  });
  sim::Box box;
  for (const sim::Disc& disc : near) box.include(disc.centre);
  const glm::dvec3 size = box.size();
  CentralSamples central{.samples = static_cast<double>(near.size()),
                         .sphere_radius = glm::length(size) / 2 + radii.largest,
                         .box = {size.x, size.y, size.z},
                         .dimension = sample_dimension(near, stop)};
  if (!(box.longest_side() > 0)) central.box.fill(2 * radii.rms);
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
  constexpr std::size_t least_points = 1024;
  constexpr double least_covered = 0.25;
  constexpr int last_level = finest_level - 3;  // on finer ones, points that share a place would be missed
  const std::vector<sim::KeyedIndex> places = places_of(discs, sample_of(discs.size(), 1U << 13), stop);
  if (places.size() < least_points) return 3;
  const Levels levels = occupied_cells(places);
  const auto covered = [&](std::size_t level) { return 1 - levels[level].once / static_cast<double>(places.size()); };
  std::size_t last = 3;
  while (last < last_level && covered(last + 1) >= least_covered) ++last;
  // the slope of a least-squares line through three levels does not depend on the middle one
  const double slope = 0.5 * std::log2(levels[last].all_cells() / levels[last - 2].all_cells());
  return std::clamp(slope, 1.0, 3.0);
}

Workload measure(const sim::Problem& problem, const SurfaceFacts& surface, const std::stop_token& stop) {
  sim::StopCheck check(stop, "measuring the samples");
  const sim::Box& box = problem.centres();
  const glm::dvec3 size = box.size();
  const sim::DiscRadii& radii = problem.radii();
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
                    .central = central_samples(problem, surface.area, stop)};
  // If all samples are at one point, their box has no size. Then uses a cube with the discs' diameter as side.
  if (!(scene_side(workload) > 0)) workload.box.fill(2 * workload.disc_radius);
  workload.sample_extent = extent_of(workload, surface.area);
  return workload;
}

}  // namespace detp::validate
