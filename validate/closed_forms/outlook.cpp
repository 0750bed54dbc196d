#include <algorithm>
#include <cmath>
#include <numbers>

#include "closed_forms.hpp"
#include "detp/model/accuracy/nearest_photons.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/model/optimum/growth.hpp"

namespace detp::validate {
namespace {

void add_growth(const ModelRequest& request, const Parameters& parameters, Outlook& found) {
  model::GrowthCase shrinking{
      .technique = request.technique, .dimension = request.workload.dimension, .form = request.form};
  if (!(shrinking.dimension >= 2)) return;
  if (const auto* cache = std::get_if<SphereCacheParameters>(&parameters)) shrinking.order = cache->order;
  const model::Growth growth = model::growth(shrinking);
  found.growth_power = growth.power;
  found.growth_logarithms = growth.logarithms;
}

bool is_uniform_field(const Workload& w) {
  return w.disc_radius <= w.sphere_radius && !w.front_facing && !(w.path_length > 0);
}

void add_uniform_field(const ModelRequest& request, Outlook& found) {
  const Workload& w = request.workload;
  found.uniform_field_deviation = model::uniform_field_deviation(w.rays, {w.disc_radius}, {w.sphere_radius});
  if (!request.target_error) return;
  found.rays_for_deviation = model::rays_for_deviation(*request.target_error, {w.disc_radius}, {w.sphere_radius});
  found.notes.emplace_back(
      "rays_for_deviation: lines at which uniform_field_deviation is the target error. It has no bias, because the "
      "field is uniform.");
}

/// For other fields: a disc that each ray hits with the mean probability p of all discs. Its relative deviation is
/// √((1 - p)/(n_R p)), as in a uniform field, if the rays hit it independently and have one power.
void add_mean_disc(const ModelRequest& request, Outlook& found) {
  const Workload& w = request.workload;
  const double hits = model::expected_hits(w) / w.samples;
  const double p = std::min(1.0, hits / w.rays);
  found.mean_disc_hits = hits;
  const double squared = (1 - p) / p;
  if (!std::isfinite(squared)) {
    if (request.target_error)
      found.notes.emplace_back("No hits are predicted: no number of rays reaches the target error.");
    return;
  }
  found.mean_disc_deviation = std::sqrt(squared / w.rays);
  if (!request.target_error) return;
  found.rays_for_mean_disc =
      saturated(squared / (static_cast<long double>(*request.target_error) * *request.target_error));
  found.notes.emplace_back(
      "rays_for_mean_disc: rays at which mean_disc_deviation is the target error: that of a disc with the mean number "
      "of hits, if rays are independent and of one power. Discs with fewer hits need more rays. It has no bias; "
      "--curvature adds that of the radius. detp run --per-disc FILE --standard-error measures the error of each "
      "disc.");
}

/// Adds the errors of estimates of a density with the given curvature. The density is the mean of the hits of all rays.
void add_curved_field(const ModelRequest& request, Outlook& found) {
  const Workload& w = request.workload;
  const double area = std::numbers::pi * w.disc_radius * w.disc_radius;
  const double density = model::expected_hits(w) / w.samples / w.rays / area;
  const model::SmoothDensity field{density, *request.curvature * density};
  const auto relative = [&](const model::DensityError& error) {
    return saturated(std::sqrt(static_cast<long double>(error.mean_square())) / density);
  };
  const model::DensityError disc = model::density_error(field, w.rays, w.disc_radius);
  found.density_bias = saturated(static_cast<long double>(disc.bias) / density);
  found.density_error = relative(disc);
  if (w.rays >= 3) {
    found.best_nearest = model::best_nearest_photons(field, w.rays);
    found.nearest_error = relative(model::nearest_photons_error(field, w.rays, *found.best_nearest));
    found.plain_nearest_error = relative(model::plain_nearest_photons_error(field, w.rays, *found.best_nearest));
  }
  if (*request.curvature == 0) return;
  found.best_density_radius = model::best_density_radius(field, w.rays);
  if (!request.target_error) return;
  found.photons_for_error = model::photons_for_error(field, *request.target_error);
  found.radius_for_error = model::best_density_radius(field, *found.photons_for_error);
  found.photons_for_nearest_error = model::photons_for_nearest_error(field, *request.target_error);
  if (const double whole = std::ceil(*found.photons_for_nearest_error); whole >= 3 && whole <= 1e18)
    found.nearest_for_error = model::best_nearest_photons(field, whole);
  found.notes.emplace_back(
      "photons_for_error: with discs of the radius that is best for so many photons, radius_for_error, not with the "
      "given disc radius. photons_for_nearest_error: with the best number of nearest photons, nearest_for_error.");
}

}  // namespace

Outlook outlook(const ModelRequest& request, const Parameters& parameters) {
  if (request.target_error) require_positive("--target-error", *request.target_error);
  Outlook found;
  add_growth(request, parameters, found);
  if (is_uniform_field(request.workload))
    add_uniform_field(request, found);
  else
    add_mean_disc(request, found);
  if (request.curvature) add_curved_field(request, found);
  return found;
}

}  // namespace detp::validate
