#include "cell_spheres.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "detp/model/lines/line_measure.hpp"

namespace detp::model {
namespace {

void require_level(int level) { require_count("level", level, 0, 300); }

/// 1 - (1 - p)^n.
double occupied(double share, double samples) { return -std::expm1(samples * std::log1p(-std::min(1.0, share))); }

/// A row of equal cells along one side of the box.
struct Row {
  double cells = 0;
  double share = 1;  ///< share of the side that one cell covers
  double ends = 0;   ///< number of the side's ends in the cell: 0, 1, or 2 if one cell covers the whole side
};

/// The first cell of a side, those between, and the last.
using Side = std::array<Row, 3>;

Side cells_along(double side, double cell) {
  constexpr double many = 0x1p30;  // with more cells, a cut cell makes no difference
  if (!(side > cell)) return {{{1, 1, 2}}};
  const double count = side / cell > many ? side / cell : std::ceil(side / cell);
  const double share = count > many ? 1 / count : cell / side;
  return {{{1, share, 1}, {count - 2, share, 0}, {1, count > many ? share : 1 - (count - 1) * share, 1}}};
}

template <class Share>
double sum_over_cells(const std::array<Side, 3>& along, double samples, const Share& share) {
  double sum = 0;
  for (const Row& x : along[0])
    for (const Row& y : along[1])
      for (const Row& z : along[2])
        if (const double cells = x.cells * y.cells * z.cells; cells > 0)
          sum += cells * occupied(share(x, y, z), samples);
  return sum;
}

bool fills_cube(const Valid<Workload>& workload) {
  return workload.dimension == 3 && workload.box[0] == workload.box[1] && workload.box[1] == workload.box[2];
}

double occupied_in_box(const Valid<Workload>& workload, double cell) {
  std::array<Side, 3> along;
  std::array<double, 3> faces{};  // share of the box's faces that lie across each axis
  for (std::size_t axis = 0; axis < 3; ++axis) {
    along[axis] = cells_along(workload.box[axis], cell);
    faces[axis] = workload.box[(axis + 1) % 3] / scene_side(workload) * workload.box[(axis + 2) % 3];
  }
  const double all = faces[0] + faces[1] + faces[2];
  const auto in_volume = [](const Row& x, const Row& y, const Row& z) { return x.share * y.share * z.share; };
  const auto on_faces = [&](const Row& x, const Row& y, const Row& z) {
    return (faces[0] * x.ends * y.share * z.share + faces[1] * x.share * y.ends * z.share +
            faces[2] * x.share * y.share * z.ends) /
           (2 * all);
  };
  const double weight = std::clamp(workload.dimension - 2, 0.0, 1.0);
  const double n = workload.samples;
  if (weight == 1 || all == 0) return sum_over_cells(along, n, in_volume);  // a needle has no faces
  if (weight == 0) return sum_over_cells(along, n, on_faces);
  return std::pow(sum_over_cells(along, n, in_volume), weight) *
         std::pow(sum_over_cells(along, n, on_faces), 1 - weight);
}

double occupied_in_extent(const Valid<Workload>& workload, double cell, int level) {
  const double dimension = std::clamp(workload.dimension, 2.0, 3.0);
  const double reached = std::pow(1.5, 3 - dimension) * sample_extent(workload) / std::pow(cell, dimension);
  const double cells = std::clamp(reached, 1.0, std::ldexp(1.0, 3 * level));
  return cells * occupied(1 / cells, workload.samples);
}

}  // namespace

double cell_sphere_radius(const Valid<Workload>& workload, int level) {
  require_level(level);
  return enclosing_radius(std::ldexp(scene_side(workload), -level), largest_radius(workload));
}

double occupied_cell_spheres(double samples, int level) {
  require_count("number of samples", samples, 1, 1e18);
  require_level(level);
  return std::ldexp(occupied(std::ldexp(1.0, -3 * level), samples), 3 * level);
}

double occupied_cell_spheres(const Valid<Workload>& workload, int level) {
  require_level(level);
  if (level == 0) return 1;
  if (workload.sample_extent == 0 && fills_cube(workload)) return occupied_cell_spheres(workload.samples, level);
  const double cell = std::ldexp(scene_side(workload), -level);
  return workload.sample_extent > 0 ? occupied_in_extent(workload, cell, level) : occupied_in_box(workload, cell);
}

double rays_in_cell_sphere(const Valid<Workload>& workload, int level) {
  using std::numbers::pi;
  const double r = std::min(cell_sphere_radius(workload, level), 1e99);  // so that the volume does not overflow
  return workload.rays * crossing_probability(workload, 4 * pi / 3 * r * r * r, 4 * pi * r * r);
}

void for_each_cell_sphere_depth(const Valid<Workload>& workload, const Valid<CellSpheresParameters>& deepest,
                                const std::function<bool(const Counts<double>&)>& visit) {
  Counts<double> counts{.visits = workload.samples, .sorted = workload.samples, .hits = expected_hits(workload)};
  double around = workload.rays;
  for (int level = 0; level <= deepest.depth; ++level) {
    if (level > 0) {
      const double spheres = occupied_cell_spheres(workload, level);
      const double rays = rays_in_cell_sphere(workload, level);
      counts.culls += spheres;
      counts.cull_tests += spheres * around;
      counts.listed += spheres * rays;
      around = rays;
    }
    counts.disc_tests = workload.samples * around;
    if (!visit(counts)) return;
  }
}

Counts<double> cell_sphere_counts(const Valid<Workload>& workload, const Valid<CellSpheresParameters>& parameters) {
  Counts<double> last;
  for_each_cell_sphere_depth(workload, parameters, [&](const Counts<double>& counts) {
    last = counts;
    return true;
  });
  return last;
}

}  // namespace detp::model
