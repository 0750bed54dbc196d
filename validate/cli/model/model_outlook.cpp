#include "model_answer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "detp/model/accuracy/nearest_photons.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/model/optimum/growth.hpp"
#include "detp/validate/cli/options/number_option.hpp"

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

bool is_uniform_field(const Workload& w) {
  return w.disc_radius <= w.sphere_radius && !w.front_facing && !(w.path_length > 0);
}

void add_uniform_field(const Workload& w, const OutlookOptions& options, Json& json) {
  json["uniform_field_deviation"] = model::uniform_field_deviation(w.rays, {w.disc_radius}, {w.sphere_radius});
  if (!options.target_error) return;
  json["rays_for_deviation"] = model::rays_for_deviation(*options.target_error, {w.disc_radius}, {w.sphere_radius});
  json["notes"].push_back(
      "rays_for_deviation: lines at which uniform_field_deviation is the target error. It has no bias, because the "
      "field "
      "is uniform.");
}

/// For other fields: a disc that each ray hits with the mean probability p of all discs. Its relative deviation is
/// √((1 - p)/(n_R p)), as in a uniform field, if the rays hit it independently and have one power.
void add_mean_disc(const Workload& w, const OutlookOptions& options, Json& json) {
  const double hits = model::expected_hits(w) / w.samples;
  const double p = std::min(1.0, hits / w.rays);
  json["mean_disc_hits"] = hits;
  const double squared = (1 - p) / p;
  if (!std::isfinite(squared)) {
    if (options.target_error)
      json["notes"].push_back("No hits are predicted: no number of rays reaches the target error.");
    return;
  }
  json["mean_disc_deviation"] = std::sqrt(squared / w.rays);
  if (!options.target_error) return;
  json["rays_for_mean_disc"] =
      saturated(squared / (static_cast<long double>(*options.target_error) * *options.target_error));
  json["notes"].push_back(
      "rays_for_mean_disc: rays at which mean_disc_deviation is the target error: that of a disc with the mean number "
      "of "
      "hits, if rays are independent and of one power. Discs with fewer hits need more rays. It has no bias; "
      "--curvature "
      "adds that of the radius. detp run --per-disc FILE --standard-error measures the error of each disc.");
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
  const double photons = model::photons_for_error(field, *options.target_error);
  const double for_nearest = model::photons_for_nearest_error(field, *options.target_error);
  json["photons_for_error"] = photons;
  json["radius_for_error"] = model::best_density_radius(field, photons);
  json["photons_for_nearest_error"] = for_nearest;
  if (const double whole = std::ceil(for_nearest); whole >= 3 && whole <= 1e18)
    json["nearest_for_error"] = model::best_nearest_photons(field, whole);
  json["notes"].push_back(
      "photons_for_error: with discs of the radius that is best for so many photons, radius_for_error, not with the "
      "given disc radius. photons_for_nearest_error: with the best number of nearest photons, nearest_for_error.");
}

}  // namespace

void OutlookOptions::add_to(CLI::App& command, ValueLists& lists) {
  add_number(command, "--curvature", curvature,
             "Laplacian of the density of hits over the density, 1/length²: adds the error of discs (bias, total, best "
             "radius) and of the nearest photons");
  lists.add(
      command, "--target-error", Values::many, ValueLists::Kind::numbers,
      [this](const std::string& text) { target_error = parse_share("--target-error", text); },
      "of the irradiance, relative, as 5% or 0.05: adds the rays that reach it");
}

const Columns& error_columns() {
  static const Columns columns{"uniform_field_deviation", "rays_for_deviation",        "mean_disc_hits",
                               "mean_disc_deviation",     "rays_for_mean_disc",        "density_bias",
                               "density_error",           "best_density_radius",       "best_nearest",
                               "nearest_error",           "plain_nearest_error",       "photons_for_error",
                               "radius_for_error",        "photons_for_nearest_error", "nearest_for_error"};
  return columns;
}

const Columns& outlook_columns() {
  static const Columns columns = Columns{"growth_power", "growth_logarithms"} + error_columns();
  return columns;
}

Json outlook(const ModelQuestion& question, const Parameters& parameters, const OutlookOptions& options) {
  if (options.target_error) require_positive("--target-error", *options.target_error);
  Json json = Json::object();
  add_growth(question, parameters, json);
  if (is_uniform_field(question.workload))
    add_uniform_field(question.workload, options, json);
  else
    add_mean_disc(question.workload, options, json);
  if (options.curvature) add_curved_field(question.workload, options, json);
  return json;
}

}  // namespace detp::cli
