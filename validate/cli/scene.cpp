#include <fmt/format.h>

#include "command.hpp"
#include "detp/validate/cli/options/workload_options.hpp"
#include "detp/validate/cli/report/answer_rows.hpp"
#include "detp/validate/cli/report/effects_report.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/progress_line.hpp"
#include "detp/validate/scene/scene.hpp"

namespace detp::cli {
namespace {

struct SceneOptions {
  WorkloadOptions workload;
  validate::SceneRequest files;  ///< to be written
};

std::string to_text(const validate::SceneAnswer& answer, const Screen& screen) {
  const validate::Job& job = answer.job;
  const Workload& w = job.workload();
  std::string text = wrapped(describe(job), screen.text_width(), 10);
  text += fmt::format("box       {:.5g} x {:.5g} x {:.5g}, r0 = {:.5g}\nsamples   {:.4g} apart, dimension D = {:.2f}\n",
                      w.box[0], w.box[1], w.box[2], w.sphere_radius, sample_distance(w), w.dimension);
  for (const std::string& remark : answer.remarks) text += wrapped("remark    " + remark, screen.text_width(), 10);
  text += "\n";
  text += effects_table(job.observed(), answer.tests_if_switched, screen);
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
  validate::SceneRequest request = options.files;
  request.job = options.workload.request(common);
  const validate::SceneAnswer found = validate::answer(request, stop, progress.report());
  note_all(common, found.job);
  Result result;
  if (found.stopped) {
    note(common, fmt::format("{}; the file is not kept", found.stopped->what()));
    result.stopped = found.stopped->progress();
  }
  result.inputs = to_json(found.job, request.job);
  result.json = json_of(validate::scene_fields(), found);
  result.text = to_text(found, common.screen());
  Table table(validate::united(workload_columns(), columns_of(validate::scene_fields())));
  Json row = workload_cells(result.inputs);
  row.update(cells_of(validate::scene_fields(), found));
  table.add(row);
  result.csv = table.csv();
  return result;
}

}  // namespace

Command scene_command(CLI::App& program) {
  CLI::App* app = program.add_subcommand("scene", "What is in a scene; writes scenes, discs and rays to files");
  app->footer("Example: detp scene @tree --rays 100000 --write-mesh tree.ply --write-rays paths.csv");
  const auto options = std::make_shared<SceneOptions>();
  options->workload.add_to(*app);
  app->add_option("--write-mesh", options->files.mesh_file, "write the triangles as PLY");
  app->add_option("--write-discs", options->files.disc_file, "write the discs, as CSV, PLY or NPY by the file's name");
  app->add_option("--write-rays", options->files.ray_file, "write the rays, as CSV, PLY or NPY by the file's name");
  return {
      app,
      [options](const CommonOptions& common, const std::stop_token& stop) { return run_scene(*options, common, stop); },
      false, describe_fields(validate::scene_fields())};
}

}  // namespace detp::cli
