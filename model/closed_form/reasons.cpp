#include "reasons.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace detp::model {
namespace {

/// Largest relative difference at which the box, the filled share and r₀ still count as those of the sweep. The box of
/// samples is slightly smaller than the cube, and samples of a scene fill their box less evenly.
constexpr double about_equal = 0.1;

bool differ(double a, double b) { return std::abs(a - b) > about_equal * b; }

}  // namespace

void Reasons::range(std::string_view what, double value, double least, double most) {
  constexpr double rounding = 1e-9;
  if (value < least * (1 - rounding)) add(fmt::format("{} {:.4g} below {:.4g}", what, value, least));
  if (value > most * (1 + rounding)) add(fmt::format("{} {:.4g} above {:.4g}", what, value, most));
}

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

bool is_counted_scene(const Valid<Workload>& workload) {
  Reasons reasons;
  uncounted_scene(workload, reasons);
  return std::move(reasons).texts().empty();
}

}  // namespace detp::model
