#include "model_outlook.hpp"

#include <cmath>
#include <numbers>

#include "detp/model/accuracy/nearest_photons.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/model/optimum/growth.hpp"
#include "number_option.hpp"

namespace detp::cli {
namespace {

void add_growth(const ModelQuestion& question, const Parameters& parameters, Json& json) {
  model::GrowthCase shrinking{
      .technique = question.technique, .dimension = question.workload.dimension, .form = question.form};
  if (!(shrinking.dimension >= 2)) return;
  if (const auto* cache = std::get_if<SphereCacheParameters>(&parameters)) shrinking.order = cache->order;
  const model::Growth growth = model::growth(shrinking);
  json["growth_power"] = growth.power;
  json["growth_logarithms"] = growth.logarithms;
}

void add_uniform_field(const Workload& w, const OutlookOptions& options, Json& json) {
  if (w.disc_radius > w.sphere_radius || w.front_facing || w.path_length > 0) return;
  json["uniform_field_deviation"] = model::uniform_field_deviation(w.rays, {w.disc_radius}, {w.sphere_radius});
  if (options.target_error)
    json["rays_for_deviation"] = model::rays_for_deviation(*options.target_error, {w.disc_radius}, {w.sphere_radius});
}

/// Adds the errors of estimates of a density with the given curvature. The density is the mean of the hits of all rays.
void add_curved_field(const Workload& w, const OutlookOptions& options, Json& json) {
  const double area = std::numbers::pi * w.disc_radius * w.disc_radius;
  const double density = model::expected_hits(w) / w.samples / w.rays / area;
  const model::SmoothDensity field{density, *options.curvature * density};
  const auto relative = [&](const model::DensityError& error) {
    return saturated(std::sqrt(static_cast<long double>(error.mean_square())) / density);
  };
  const model::DensityError disc = model::density_error(field, w.rays, w.disc_radius);
  json["density_bias"] = saturated(static_cast<long double>(disc.bias) / density);
  json["density_error"] = relative(disc);
  if (w.rays >= 3) {
    const double nearest = model::best_nearest_photons(field, w.rays);
    json["best_nearest"] = nearest;
    json["nearest_error"] = relative(model::nearest_photons_error(field, w.rays, nearest));
    json["plain_nearest_error"] = relative(model::plain_nearest_photons_error(field, w.rays, nearest));
  }
  if (*options.curvature == 0) return;
  json["best_density_radius"] = model::best_density_radius(field, w.rays);
  if (!options.target_error) return;
  json["photons_for_error"] = model::photons_for_error(field, *options.target_error);
  json["photons_for_nearest_error"] = model::photons_for_nearest_error(field, *options.target_error);
}

}  // namespace

void OutlookOptions::add_to(CLI::App& command) {
  add_number(command, "--curvature", curvature,
             "Laplacian of the density of hits over the density, 1/length²: adds the error of discs (bias, total, best "
             "radius) and of the nearest photons");
  add_number(command, "--target-error", target_error, "relative: adds the rays that reach it");
}

const Columns& outlook_columns() {
  static const Columns columns{"growth_power",        "growth_logarithms", "uniform_field_deviation",
                               "rays_for_deviation",  "density_bias",      "density_error",
                               "best_density_radius", "best_nearest",      "nearest_error",
                               "plain_nearest_error", "photons_for_error", "photons_for_nearest_error"};
  return columns;
}

Json outlook(const ModelQuestion& question, const Parameters& parameters, const OutlookOptions& options) {
  if (options.target_error) require_positive("--target-error", *options.target_error);
  Json json = Json::object();
  add_growth(question, parameters, json);
  add_uniform_field(question.workload, options, json);
  if (options.curvature) add_curved_field(question.workload, options, json);
  return json;
}

}  // namespace detp::cli
