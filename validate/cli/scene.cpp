#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "command.hpp"
#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/files/disc_file.hpp"
#include "detp/sim/files/mesh_writer.hpp"
#include "detp/sim/files/ray_file.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/validate/cli/options/workload_options.hpp"
#include "detp/validate/cli/report/answer_rows.hpp"
#include "detp/validate/cli/report/effects_report.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/progress_line.hpp"
#include "detp/validate/cli/text/table.hpp"

namespace detp::cli {
namespace {

struct SceneOptions {
  WorkloadOptions workload;
  std::optional<std::string> mesh_file;
  std::optional<std::string> disc_file;
  std::optional<std::string> ray_file;
};

void write_mesh(const std::string& path, const validate::JobRequest& request, const std::stop_token& stop) {
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

std::string csv_of(const Json& inputs, const Json& json) {
  const Columns columns{"triangles",    "box_x",        "box_y", "box_z", "distance_over_radius",
                        "read_seconds", "trace_seconds"};
  Json row = workload_cells(inputs);
  row.update({{"triangles", json["triangles"]},
              {"box_x", json["box"][0]},
              {"box_y", json["box"][1]},
              {"box_z", json["box"][2]},
              {"distance_over_radius", json["distance_over_radius"]},
              {"read_seconds", json["read_seconds"]},
              {"trace_seconds", json["trace_seconds"]}});
  row.update(effect_cells(json["effects"]));
  row["warnings"] = joined(json["warnings"]);
  row["remarks"] = joined(json["remarks"]);
  Table table(workload_columns() + columns + effect_columns() + Columns{"warnings", "remarks"});
  table.add(row);
  return table.csv();
}

/// What the user should know about the scene's samples. In the rooms that were tried (bedroom.ply, sponza.ply), the vertices
/// have D = 1.4 and 1.2; with five times as many samples, D is 2.1 and 2.0.
std::vector<std::string> remarks_on(const validate::Job& job, const validate::JobRequest& request) {
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

std::string to_text(const validate::Job& job, const std::vector<double>& if_switched,
                    const std::vector<std::string>& remarks, const Screen& screen) {
  const Workload& w = job.workload();
  std::string text = wrapped(describe(job), screen.text_width(), 10);
  text += fmt::format("box       {:.5g} x {:.5g} x {:.5g}, r0 = {:.5g}\nsamples   {:.4g} apart, dimension D = {:.2f}\n",
                      w.box[0], w.box[1], w.box[2], w.sphere_radius, sample_distance(w), w.dimension);
  for (const std::string& remark : remarks) text += wrapped("remark    " + remark, screen.text_width(), 10);
  text += "\n";
  text += effects_table(job.observed(), if_switched, screen);
  text += legend(screen,
                 "X: distance between neighbouring samples over the discs' radius d. D: dimension of the samples, 2 on "
                 "surfaces, 3 in a volume. r0: radius of S0, the sphere around all discs. on: predictions take the "
                 "effect into account. Tests if switched: predicted tests of a tree of boxes with the effect switched "
                 "by hand, over those as it is.");
  const sim::Observed& observed = job.observed();
  return text +
         fmt::format(
             "\nmeasured in {:.2g} ms on {} rays and {} discs; scene read or made in {:.3g} s, rays in {:.3g} s\n",
             1e3 * observed.seconds, observed.rays, observed.discs, job.read_seconds, job.trace_seconds);
}

Result run_scene(const SceneOptions& options, const CommonOptions& common, const std::stop_token& stop) {
  const ProgressLine progress(common.quiet);
  const validate::JobRequest request = options.workload.request(common);
  const bool writes = options.disc_file || options.ray_file;
  if (options.mesh_file) write_mesh(*options.mesh_file, request, stop);
  const validate::Job job = validate::make_job(request, stop, sim::part_of(progress.report(), 0, writes ? 0.5 : 1));
  note_all(common, job);
  const Workload& w = job.workload();
  Result result;
  try {
    const std::size_t written = (options.disc_file ? job.discs.size() : 0) + (options.ray_file ? job.rays.size() : 0);
    progress.show({"writing", 0.5, 1, 8 * static_cast<double>(written)});
    if (options.disc_file) sim::write_discs(*options.disc_file, job.discs, stop, job.vertices);
    if (options.ray_file) sim::write_rays(*options.ray_file, job.paths(), stop);
  } catch (const sim::Stopped& stopped) {
    note(common, fmt::format("{}; the file is not kept", stopped.what()));
    result.stopped = stopped.progress();
  }

  const std::vector<std::string> remarks = remarks_on(job, request);
  result.inputs = to_json(job, request);
  result.json = {{"scene", job.name},
                 {"triangles", job.triangles},
                 {"samples", job.discs.size()},
                 {"rays", job.rays.size()},
                 {"photons", job.independent_photons()},
                 {"box", w.box},
                 {"sphere_radius", w.sphere_radius},
                 {"sample_distance", sample_distance(w)},
                 {"disc_radius", w.disc_radius},
                 {"distance_over_radius", sample_distance(w) / w.disc_radius},
                 {"dimension", w.dimension},
                 {"path_length", w.path_length},
                 {"effects", to_json(job.observed().effects)},
                 {"effects_seconds", job.observed().seconds},
                 {"notices", job.notices},
                 {"warnings", job.all_said()},
                 {"remarks", remarks},
                 {"read_seconds", job.read_seconds},
                 {"trace_seconds", job.trace_seconds}};
  result.json.update(ledgers_json(job));
  const std::vector<double> if_switched = tests_if_switched(job, stop);
  for (std::size_t i = 0; i < if_switched.size(); ++i)
    if (if_switched[i] > 0) result.json["effects"][i]["tests_if_switched"] = if_switched[i];
  result.text = to_text(job, if_switched, remarks, common.screen());
  result.csv = csv_of(result.inputs, result.json);
  return result;
}

}  // namespace

Command scene_command(CLI::App& program) {
  CLI::App* app = program.add_subcommand("scene", "What is in a scene; writes scenes, discs and rays to files");
  app->footer("Example: detp scene @tree --rays 100000 --write-mesh tree.ply --write-rays paths.csv");
  const auto options = std::make_shared<SceneOptions>();
  options->workload.add_to(*app);
  app->add_option("--write-mesh", options->mesh_file, "write the triangles as PLY");
  app->add_option("--write-discs", options->disc_file, "write the discs, as CSV, PLY or NPY by the file's name");
  app->add_option("--write-rays", options->ray_file, "write the rays, as CSV, PLY or NPY by the file's name");
  return {app, [options](const CommonOptions& common, const std::stop_token& stop) {
            return run_scene(*options, common, stop);
          }};
}

}  // namespace detp::cli
