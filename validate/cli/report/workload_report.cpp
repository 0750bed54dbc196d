#include "workload_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/photons/light_ledger.hpp"

namespace detp::cli {
namespace {

/// 100000 as "100 000".
std::string spaced(double count) {
  std::string digits = fmt::format("{:.0f}", count);
  for (auto place = static_cast<std::ptrdiff_t>(digits.size()) - 3; place > 0; place -= 3)
    digits.insert(static_cast<std::size_t>(place), " ");
  return digits;
}

/// "; lights: area, spot (up: y)"; empty if the rays are not from lights, or these are the scene's own.
std::string lights_of(const validate::Job& job) {
  if (!job.lights_placed || job.field != sim::Field::photons || job.rays_from_file) return "";
  std::vector<std::string_view> kinds;
  for (const sim::Light& light : job.lights) kinds.push_back(name(sim::kind_of(light)));
  return fmt::format("; light{}: {} (up: {})", kinds.size() == 1 ? "" : "s", fmt::join(kinds, ", "), sim::name(job.up));
}

bool has_ends(const sim::Ray& ray) { return ray.length != sim::unbounded; }

/// What the rays are, whatever the effects are: "pieces of photon paths".
std::string_view rays_of(const validate::Job& job) {
  if (job.rays_from_file) return std::ranges::any_of(job.rays, has_ends) ? "segments from a file" : "lines from a file";
  if (job.field == sim::Field::mixed) return "of a mixed field: isotropic lines, parallel lines, segments from a point";
  return job.field == sim::Field::photons ? "pieces of photon paths" : "isotropic lines";
}

std::string scene_line(const validate::Job& job, const std::string& measured) {
  const Workload& w = job.given;
  std::string text = fmt::format("scene     {}: ", shown_path(job.name));
  if (job.triangles > 0) text += fmt::format("{} triangles, ", spaced(static_cast<double>(job.triangles)));
  return text + fmt::format("{} discs of radius d = {:.4g} ({:.3g} % of the scene){}\n", spaced(w.samples),
                            w.disc_radius, 100 * w.disc_radius / scene_side(w), measured);
}

validate::RaysTaken rays_taken(const validate::Job& job) {
  return {job.given.rays, static_cast<double>(job.independent_photons()), job.light};
}

std::string rays_line(const validate::Job& job, const validate::RaysTaken& taken, const std::string& lengths) {
  // where each ray is a photon, their number is that of the rays
  const std::string photons = job.numbered() ? fmt::format(", {} photons", spaced(taken.photons)) : "";
  return fmt::format("rays      {} {}{}{}{}{}\n", spaced(taken.rays), rays_of(job), photons, lengths, lights_of(job),
                     taken.light ? sim::lost_light(*taken.light) : "");
}

/// ", mean length 0.30 of the scene's side", or that predictions neglect the ends; empty for lines.
std::string lengths_of(const validate::Job& job) {
  const bool end = job.rays_from_file ? std::ranges::any_of(job.rays, has_ends) : job.field == sim::Field::photons;
  if (!end) return "";
  if (job.workload().path_length > 0)
    return fmt::format(", mean length {:.2f} of the scene's side", job.workload().path_length / scene_side(job.given));
  return ", predicted as if they were lines (effect finite paths: off)";
}

}  // namespace

void note_all(const CommonOptions& common, const validate::Job& job) {
  for (const std::string& notice : job.notices) note(common, notice);
  for (const std::string& warning : job.warnings) note(common, "warning: " + warning);
}

std::string describe(const validate::Job& job) {
  const Workload& w = job.workload();
  return scene_line(job, fmt::format(", X = {:.2f}, D = {:.2f}", sample_distance(w) / w.disc_radius, w.dimension)) +
         rays_line(job, rays_taken(job), lengths_of(job));
}

std::string describe_given(const validate::Job& job, const std::optional<validate::RaysTaken>& taken) {
  if (job.without_rays) return scene_line(job, lights_of(job));
  return scene_line(job, "") + rays_line(job, taken.value_or(rays_taken(job)), "");
}

std::string threads_text(int threads) { return fmt::format("{} thread{}", threads, threads == 1 ? "" : "s"); }

}  // namespace detp::cli
