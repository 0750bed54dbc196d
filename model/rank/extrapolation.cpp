#include "extrapolation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "detp/model/sphere_cache/sphere_count.hpp"
#include "registry.hpp"

namespace detp::model {
namespace {

/// Largest relative difference at which the box, the filled share and r₀ still count as those of the sweep. The box of
/// samples is slightly smaller than the cube, and samples of a scene fill their box less evenly.
constexpr double about_equal = 0.1;

bool differ(double a, double b) { return std::abs(a - b) > about_equal * b; }

/// Adds reasons that apply to every technique: workloads outside the sweep.
void uncounted_scene(const Valid<Workload>& workload, Reasons& reasons) {
  const double side = scene_side(workload);
  if (workload.path_length > 0) reasons.add("rays that end: only lines were counted");
  constexpr double exactly = 0.05;  // the accuracy of a measured dimension
  if (workload.dimension < 2 - exactly)
    reasons.add(fmt::format("dimension {:.4g} below 2", workload.dimension));
  else if (workload.dimension > 2 + exactly && workload.dimension < 3 - exactly)
    reasons.add(fmt::format("dimension {:.4g} between 2 and 3", workload.dimension));
  if (differ(*std::min_element(workload.box.begin(), workload.box.end()), side))
    reasons.add(fmt::format("box {:.4g} x {:.4g} x {:.4g}: only cubes were counted", workload.box[0], workload.box[1],
                            workload.box[2]));
  Workload box_filled = workload;
  box_filled.sample_extent = 0;
  const double filled = sample_extent(workload) / sample_extent(box_filled);
  if (differ(filled, 1)) reasons.add(fmt::format("samples that fill {:.3g} of the box or its faces, not all", filled));
  if (!workload.radii.empty())
    reasons.add(fmt::format("disc radii up to {:.4g}, {:.3g} times the root mean square: only equal discs were counted",
                            largest_radius(workload), largest_radius(workload) / workload.disc_radius));
  const double around = enclosing_radius(side, largest_radius(workload));
  if (differ(workload.sphere_radius, around))
    reasons.add(fmt::format("r0 {:.4g}, not {:.4g} around the cube of the samples", workload.sphere_radius, around));
}

void range_of_samples(const Valid<Workload>& workload, Reasons& reasons) {
  reasons.range("samples", workload.samples, 1e3, 1e7);
  reasons.range("d over r0", workload.disc_radius / workload.sphere_radius, 1e-4, 0.2);
}

}  // namespace

void Reasons::range(std::string_view what, double value, double least, double most) {
  constexpr double rounding = 1e-9;
  if (value < least * (1 - rounding)) add(fmt::format("{} {:.4g} below {:.4g}", what, value, least));
  if (value > most * (1 + rounding)) add(fmt::format("{} {:.4g} above {:.4g}", what, value, most));
}

void uncounted_cache(const Valid<Workload>& workload, const Parameters& parameters, Reasons& reasons) {
  const auto& cache = std::get<SphereCacheParameters>(parameters);
  if (cache.spheres == 0) return;  // brute force
  uncounted_scene(workload, reasons);
  range_of_samples(workload, reasons);
  reasons.range("Q", cache.ratio, 0.3, 0.9);
  const auto count = [&](Form form) {
    return sphere_count(form, {cache.ratio}, {workload.disc_radius}, {workload.sphere_radius});
  };
  if (cache.spheres > count(Form::published))
    reasons.add(fmt::format("k {}: only {} spheres hold a disc", cache.spheres, count(Form::corrected)));
  if (cache.order == SampleOrder::none) reasons.add("samples in no order: only sorted ones were counted");
}

void uncounted_cells(const Valid<Workload>& workload, const Parameters& parameters, Reasons& reasons) {
  uncounted_scene(workload, reasons);
  range_of_samples(workload, reasons);
  reasons.range("depth", std::get<CellSpheresParameters>(parameters).depth, 1, 6);
}

void uncounted_sphere_tree(const Valid<Workload>& workload, const Parameters& parameters, Reasons& reasons) {
  const auto& tree = std::get<SphereTreeParameters>(parameters);
  uncounted_scene(workload, reasons);
  range_of_samples(workload, reasons);
  reasons.range("fan-out", tree.fan_out, 4, 8);
  reasons.range("leaf", tree.leaf, 4, 16);
}

void uncounted_box_tree(const Valid<Workload>& workload, const Parameters& parameters, Reasons& reasons) {
  const auto& tree = std::get<BoxTreeParameters>(parameters);
  uncounted_scene(workload, reasons);
  reasons.range("samples", workload.samples, 0x1p10, 0x1p20);
  reasons.range("d over sample distance", workload.disc_radius / sample_distance(workload), 0x1p-10, 0x1p3);
  reasons.range("d over the scene's side", workload.disc_radius / scene_side(workload), 0, 0.16);
  reasons.range("fan-out", tree.fan_out, 2, 16);
  reasons.range("leaf", tree.leaf, 1, 256);
}

void uncounted_octree(const Valid<Workload>& workload, const Parameters& parameters, Reasons& reasons) {
  uncounted_scene(workload, reasons);
  range_of_samples(workload, reasons);
  reasons.range("depth", std::get<OctreeParameters>(parameters).depth, 1, 7);
}

void uncounted_grid(const Valid<Workload>& workload, const Parameters& parameters, Reasons& reasons) {
  uncounted_scene(workload, reasons);
  range_of_samples(workload, reasons);
  reasons.range("cells a side", std::get<GridParameters>(parameters).cells, 2, 128);
}

bool is_counted_scene(const Valid<Workload>& workload) {
  Reasons reasons;
  uncounted_scene(workload, reasons);
  return std::move(reasons).texts().empty();
}

std::vector<std::string> extrapolations(const Valid<Workload>& workload, const Valid<Candidate>& candidate) {
  Reasons reasons;
  if (const auto uncounted = model_of(candidate.technique).uncounted)
    uncounted(workload, candidate.parameters, reasons);
  return std::move(reasons).texts();
}

}  // namespace detp::model
