#include <fmt/format.h>

#include <stdexcept>

#include "command.hpp"
#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/files/disc_file.hpp"
#include "detp/sim/files/mesh_writer.hpp"
#include "detp/sim/files/ray_file.hpp"
#include "detp/sim/scene/open/open_scene.hpp"
#include "outputs.hpp"
#include "progress_line.hpp"
#include "table.hpp"
#include "text_table.hpp"
#include "workload_options.hpp"

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
  const sim::Scene scene = sim::open_scene({*request.scene, std::nullopt, request.seed}, stop);
  if (scene.mesh.triangles.empty())
    throw std::invalid_argument(fmt::format("{} has no triangles to write", shown_path(scene.name)));
  sim::write_ply(path, scene.mesh, stop);
}

std::string csv_of(const Json& inputs, const Json& json) {
  const Columns columns{"triangles", "box_x", "box_y", "box_z", "distance_over_radius", "read_seconds"};
  Json row = workload_cells(inputs);
  row.update({{"triangles", json["triangles"]},
              {"box_x", json["box"][0]},
              {"box_y", json["box"][1]},
              {"box_z", json["box"][2]},
              {"distance_over_radius", json["distance_over_radius"]},
              {"read_seconds", json["read_seconds"]}});
  row.update(effect_cells(json["effects"]));
  row["warnings"] = joined(json["warnings"]);
  Table table(workload_columns() + columns + effect_columns() + Columns{"warnings"});
  table.add(row);
  return table.csv();
}

std::string effects_table(const Workload& workload, const Screen& screen) {
  TextTable table({{.head = "effect", .align = Align::left},
                   {.head = "evidence", .align = Align::left, .spare = 1},
                   {.head = "value"},
                   {.head = "on", .align = Align::left}});
  for (const Json& effect : effects_json(workload)) {
    const bool on = effect["on"].get<bool>();
    table.add({{effect["name"].get<std::string>()},
               {effect["meaning"].get<std::string>()},
               {fmt::format("{:.2f}", effect["evidence"].get<double>())},
               {on ? "on" : "off", on ? Style::good : Style::faint}});
  }
  return table.text(screen);
}

std::string to_text(const validate::Job& job, const Screen& screen) {
  const Workload& w = job.workload;
  std::string text = wrapped(describe(job), screen.text_width(), 10);
  text +=
      fmt::format("box       {:.5g} x {:.5g} x {:.5g}, r0 = {:.5g}\nsamples   {:.4g} apart, dimension D = {:.2f}\n\n",
                  w.box[0], w.box[1], w.box[2], w.sphere_radius, sample_distance(w), w.dimension);
  text += effects_table(w, screen);
  text += legend(screen,
                 "X: distance between neighbouring samples over the discs' radius d. D: dimension of the samples, 2 on "
                 "surfaces, 3 in a volume. r0: radius of S0, the sphere around all discs. on: predictions take the "
                 "effect into account.");
  return text + fmt::format("\nread or made in {:.3g} s\n", job.read_seconds);
}

Result run_scene(const SceneOptions& options, const CommonOptions& common, const std::stop_token& stop) {
  check_outputs({{"--output", common.output},
                 {"--write-mesh", options.mesh_file},
                 {"--write-discs", options.disc_file},
                 {"--write-rays", options.ray_file}});
  const ProgressLine progress(common);
  const validate::JobRequest request = options.workload.request(common);
  const bool writes = options.disc_file || options.ray_file;
  if (options.mesh_file) write_mesh(*options.mesh_file, request, stop);
  const validate::Job job = validate::make_job(request, stop, sim::part_of(progress.report(), 0, writes ? 0.5 : 1));
  note_all(common, job);
  Result result;
  try {
    const std::size_t written = (options.disc_file ? job.discs.size() : 0) + (options.ray_file ? job.rays.size() : 0);
    progress.show({"writing", 0.5, 1, 8 * static_cast<double>(written)});
    if (options.disc_file) sim::write_discs(*options.disc_file, job.discs, stop);
    if (options.ray_file) sim::write_rays(*options.ray_file, job.rays, stop);
  } catch (const sim::Stopped& stopped) {
    note(common, fmt::format("{}; the file is not kept", stopped.what()));
    result.stopped = stopped.progress();
  }

  const Workload& w = job.workload;
  result.inputs = to_json(job, request);
  result.json = {{"scene", job.name},
                 {"triangles", job.triangles},
                 {"samples", job.discs.size()},
                 {"rays", job.rays.size()},
                 {"box", w.box},
                 {"sphere_radius", w.sphere_radius},
                 {"sample_distance", sample_distance(w)},
                 {"disc_radius", w.disc_radius},
                 {"distance_over_radius", sample_distance(w) / w.disc_radius},
                 {"dimension", w.dimension},
                 {"path_length", w.path_length},
                 {"effects", effects_json(w)},
                 {"notices", job.notices},
                 {"warnings", job.warnings},
                 {"read_seconds", job.read_seconds}};
  result.text = to_text(job, common.screen());
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
  app->add_option("--write-discs", options->disc_file, "write the discs as CSV");
  app->add_option("--write-rays", options->ray_file, "write the rays as CSV");
  return {app, [options](const CommonOptions& common, const std::stop_token& stop) {
            return run_scene(*options, common, stop);
          }};
}

}  // namespace detp::cli
