#include "scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "detp/model/rank/predict.hpp"
#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/files/disc_file.hpp"
#include "detp/sim/files/mesh_file.hpp"
#include "detp/sim/files/ray_file.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/validate/answer/parts.hpp"

namespace detp::validate {
namespace {

void write_mesh(const std::string& path, const JobRequest& request, const std::stop_token& stop) {
  if (!request.scene) throw std::invalid_argument("--write-mesh takes a scene with triangles");
  const sim::Scene scene = sim::open_scene({.name = *request.scene,
                                            .samples = {},
                                            .seed = request.seed,
                                            .crease = request.crease.value_or(sim::default_crease)},
                                           stop);
  if (scene.mesh.triangles.empty())
    throw std::invalid_argument(fmt::format("{} has no triangles to write", shown_path(scene.name)));
  sim::write_ply(path, scene.mesh, stop);
}

/// What the user should know about the scene's samples. In the rooms that were tried (bedroom.ply, sponza.ply), the vertices
/// have D = 1.4 and 1.2; with five times as many samples, D is 2.1 and 2.0.
std::vector<std::string> remarks_on(const Job& job, const JobRequest& request) {
  constexpr double nearly_curves = 1.5;
  constexpr double enough = 5;
  if (job.triangles == 0 || request.disc_file || job.workload().dimension >= nearly_curves) return {};
  const double vertices = std::max(static_cast<double>(job.discs.size()), 0.5 * static_cast<double>(job.triangles));
  return {fmt::format(
      "D = {:.2f}: the samples lie along lines more than on surfaces. Vertices are few on large faces, and many along "
      "edges and on small parts, so the irradiance of large faces is hardly sampled. --samples {:.0f} adds samples "
      "that are "
      "spread evenly over the faces.",
      job.workload().dimension, enough * vertices)};
}

/// The effects that are on, but for one that is switched, as --effects takes them.
sim::EffectSelection switched(const std::vector<sim::EffectReport>& effects, const sim::Effect& one) {
  std::string names;
  for (const sim::EffectReport& report : effects) {
    const bool on = report.on != (report.effect == &one);
    if (on && !report.effect->is_input) names += (names.empty() ? "" : ",") + sim::option_name(*report.effect);
  }
  return sim::EffectSelection(names.empty() ? "none" : names);
}

double tests_of(const Workload& workload) {
  const Counts<double> counts = model::predict(workload, Candidate{Technique::box_tree, BoxTreeParameters{8, 16}});
  return counts.cull_tests + counts.disc_tests;
}

std::vector<double> tests_if_switched(const Job& job, const std::stop_token& stop) {
  const auto& effects = job.observed().effects;
  const sim::Problem& problem = job.problem();
  const double as_is = tests_of(job.observed().workload);
  std::vector<double> ratios;
  for (const sim::EffectReport& report : effects) {
    const bool is_input = report.effect->is_input;
    ratios.push_back(
        is_input
            ? 0
            : tests_of(sim::observe(problem, job.surface, switched(effects, *report.effect), stop).workload) / as_is);
  }
  return ratios;
}

/// Returns what ended the writing early.
std::optional<sim::Stopped> write_files(const SceneRequest& request, const Job& job, const std::stop_token& stop) {
  try {
    if (request.disc_file) sim::write_discs(*request.disc_file, job.discs, stop, job.vertices);
    if (request.ray_file) sim::write_rays(*request.ray_file, job.paths(), stop, job.bands);
  } catch (const sim::Stopped& stopped) {
    return stopped;
  }
  return std::nullopt;
}

Json effects_json(const SceneAnswer& answer) {
  Json effects = to_json(answer.job.observed().effects);
  for (std::size_t i = 0; i < answer.tests_if_switched.size(); ++i)
    if (answer.tests_if_switched[i] > 0) effects[i]["tests_if_switched"] = answer.tests_if_switched[i];
  return effects;
}

}  // namespace

SceneAnswer answer(const SceneRequest& request, const std::stop_token& stop, const sim::ReportPhase& progress) {
  const bool writes = request.disc_file || request.ray_file;
  if (request.mesh_file) write_mesh(*request.mesh_file, request.job, stop);
  SceneAnswer answer{.job = make_job(request.job, stop, sim::part_of(progress, 0, writes ? 0.5 : 1))};
  const Job& job = answer.job;
  const std::size_t written = (request.disc_file ? job.discs.size() : 0) + (request.ray_file ? job.rays.size() : 0);
  if (progress) progress({"writing", 0.5, 1, 8 * static_cast<double>(written)});
  answer.stopped = write_files(request, job, stop);
  answer.remarks = remarks_on(job, request.job);
  answer.tests_if_switched = tests_if_switched(job, stop);
  return answer;
}

const Fields<SceneAnswer>& scene_fields() {
  using Answer = SceneAnswer;
  const auto workload = [](auto value) {
    return [value](const Answer& answer) { return std::invoke(value, answer.job.workload()); };
  };
  static const Fields<Answer> fields{
      Field<Answer>("scene", "", "its name, or its file", [](const Answer& a) { return a.job.name; }).in_json_alone(),
      {"triangles", "", "of the scene's surfaces", [](const Answer& a) { return a.job.triangles; }},
      Field<Answer>("samples", "", "where irradiance is estimated: discs",
                    [](const Answer& a) { return a.job.discs.size(); })
          .in_json_alone(),
      Field<Answer>("rays", "", "of photon paths their pieces", [](const Answer& a) { return a.job.rays.size(); })
          .in_json_alone(),
      Field<Answer>("photons", "", "independent of one another",
                    [](const Answer& a) { return a.job.independent_photons(); })
          .in_json_alone(),
      Field<Answer>("box", "length", "sides of the box around the samples", workload(&Workload::box))
          .in({{"box_x", "/0"}, {"box_y", "/1"}, {"box_z", "/2"}}),
      Field<Answer>("sphere_radius", "length", "r0 of S0, the sphere around all discs",
                    workload(&Workload::sphere_radius))
          .in_json_alone(),
      Field<Answer>("sample_distance", "length", "between neighbouring samples",
                    workload([](const Workload& w) { return sample_distance(w); }))
          .in_json_alone(),
      Field<Answer>("disc_radius", "length", "d", workload(&Workload::disc_radius)).in_json_alone(),
      {"distance_over_radius", "", "X", workload([](const Workload& w) { return sample_distance(w) / w.disc_radius; })},
      Field<Answer>("dimension", "", "D of the samples: 2 on surfaces, 3 in a volume", workload(&Workload::dimension))
          .in_json_alone(),
      Field<Answer>("path_length", "length", "mean of the rays that end; 0: none does",
                    workload(&Workload::path_length))
          .in_json_alone(),
      {"read_seconds", "s", "for reading or making scene and discs",
       [](const Answer& a) { return a.job.read_seconds; }},
      {"trace_seconds", "s", "for making rays", [](const Answer& a) { return a.job.trace_seconds; }},
      effects_field<Answer>(effects_json),
      Field<Answer>("effects_seconds", "s", "for the evidence of all effects",
                    [](const Answer& a) { return a.job.observed().seconds; })
          .in_json_alone(),
      Field<Answer>("notices", "", "what was corrected in the input", [](const Answer& a) { return a.job.notices; })
          .in_json_alone(),
      Field<Answer>("warnings", "", "all that was said on standard error",
                    [](const Answer& a) { return a.job.all_said(); }),
      Field<Answer>("remarks", "", "on the samples", [](const Answer& a) { return a.remarks; }),
      Field<Answer>("light", "", "how photon paths ended",
                    [](const Answer& a) { return a.job.light ? light_json(*a.job.light) : left_out(); })
          .in_json_alone(),
      Field<Answer>("geometry", "", "faces of the scene's files", [](const Answer& a) {
        return a.job.triangles > 0 ? geometry_json(a.job.polygons, a.job.normals_made, a.job.coincident) : left_out();
      }).in_json_alone()};
  return fields;
}

}  // namespace detp::validate
