#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "detp/model/vocabulary/quoted.hpp"
#include "job.hpp"

namespace detp::validate {
bool on_faces(const Workload& workload) { return workload.dimension < 2.5; }

Length parse_length(std::string_view text) {
  const bool relative = text.ends_with('%');
  std::string_view digits = text;
  if (relative) digits.remove_suffix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size())
    throw std::invalid_argument(
        fmt::format("disc radius must be a length or a percentage, as 0.02 or 4% (got {})", shortened(text)));
  require_positive("disc radius", value);
  const Length length{relative ? value / 100 : value, relative};
  require_positive("disc radius", length.value);  // a hundredth of the smallest double is 0
  return length;
}

Workload workload_of_numbers(const JobRequest& request) {
  if (!request.samples) throw std::invalid_argument("without a scene, the number of samples is needed");
  if (!request.disc_radius) throw std::invalid_argument("without a scene, the disc radius is needed");
  if (!request.sphere_radius && !request.scene_side)
    throw std::invalid_argument("without a scene, its size is needed: the radius of S0 or the side of the scene");
  if (request.sphere_radius) require_positive("sphere radius", *request.sphere_radius);
  if (request.scene_side) require_positive("scene side", *request.scene_side);
  double d = request.disc_radius->value;
  double side = request.scene_side.value_or(0);
  if (request.disc_radius->relative) {
    // Solves r₀ = s√3/2 + d for s, where d is the given share of s.
    if (!request.scene_side) side = *request.sphere_radius / (std::sqrt(0.75) + d);
    d *= side;
  }
  const double outer = request.sphere_radius.value_or(enclosing_radius(side, d));
  // If d >= r₀, no cube of samples has this r₀. Then uses the cube inscribed in S₀.
  if (!(side > 0)) side = (d < outer ? outer - d : outer) / std::sqrt(0.75);
  Workload workload =
      cube_workload(request.rays.value_or(rays_by_default), *request.samples, d, side, request.dimension.value_or(3));
  workload.sphere_radius = outer;
  workload.sample_extent = request.sample_extent.value_or(0);
  if (request.sample_extent) require_positive("sample extent", *request.sample_extent);
  workload.front_facing = request.front_facing;
  check(workload);
  return workload;
}

std::string_view name_of_numbers(const Workload& workload) {
  return on_faces(workload) ? "uniform samples on the faces of a cube" : "uniform samples in a cube";
}

}  // namespace detp::validate
