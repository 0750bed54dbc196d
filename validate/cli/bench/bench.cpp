#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "bench_report.hpp"
#include "detp/validate/cli/command.hpp"
#include "detp/validate/cli/options/candidate_options.hpp"
#include "detp/validate/cli/options/cost_options.hpp"
#include "detp/validate/cli/options/value_lists.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/progress_line.hpp"

namespace detp::cli {
namespace {

struct BenchCommand {
  std::string effort = "quick";
  std::optional<std::string> scene;
  std::string rays;
  std::string samples;
  std::string disc_radii;
  std::vector<std::string> fields;
  std::vector<std::string> techniques;
  std::string embree_modes = "best";
  int repeat = 5;
  std::optional<double> most_hits;
  InstructionSetOption instruction_set;
  CostOptions costs;
  bool regret = false;
  std::optional<std::uint64_t>
      families;  ///< seed of the families of scenes that replace the other workloads of --regret
  const CLI::App* app = nullptr;

  [[nodiscard]] validate::BenchEffort effort_asked() const {
    return effort == "thorough" ? validate::BenchEffort::thorough : validate::BenchEffort::quick;
  }
  [[nodiscard]] std::vector<sim::Field> fields_asked() const {
    std::vector<sim::Field> asked;
    for (const std::string& field : fields)
      asked.push_back(field == "photons" ? sim::Field::photons : sim::Field::isotropic);
    return asked;
  }
};

/// The folder of the meshes; empty: unknown.
std::string scene_folder() {
  const char* folder = std::getenv("DETP_SCENES");
  return folder != nullptr ? folder : "";
}

/// Throws std::invalid_argument if --regret was given with options that it excludes, or left out with one that it takes alone.
void check_regret(const BenchCommand& command) {
  for (const char* option :
       {"--rays", "--samples", "--disc-radius", "--techniques", "--embree-modes", "--repeat", "--most-hits"})
    if (command.regret && command.app->get_option(option)->count() > 0)
      throw std::invalid_argument(fmt::format(
          "{} and --regret exclude each other; SCENE, --field and --effort select the workloads of --regret", option));
  if (command.families && !command.regret) throw std::invalid_argument("--families belongs to --regret");
}

std::vector<double> counts_of(std::string_view option, const std::string& list) {
  std::vector<double> counts;
  if (list.empty()) return counts;
  for (const std::string& text : values_of(option, list, true)) {
    counts.push_back(parse_count(option, text));
    require_count(option, counts.back(), 1, 4e9);
  }
  return counts;
}

validate::BenchAxes axes_of(const BenchCommand& command) {
  validate::BenchAxes axes{.scene = command.scene,
                           .fields = command.fields_asked(),
                           .samples = counts_of("--samples", command.samples),
                           .disc_radii = {},
                           .rays = counts_of("--rays", command.rays)};
  if (!command.disc_radii.empty())
    for (const std::string& radius : values_of("--disc-radius", command.disc_radii))
      axes.disc_radii.push_back(validate::parse_length(radius));
  return axes;
}

std::vector<Technique> techniques_of(const BenchCommand& command) {
  std::vector<Technique> techniques;
  for (const std::string& text : command.techniques) {
    const Technique technique = parse_technique(text);
    if (!record_of(technique).exact)
      throw std::invalid_argument(text + " does not find all hits; bench compares exact techniques only");
    techniques.push_back(technique);
  }
  return techniques;
}

validate::BenchRequest bench_request(const BenchCommand& command, const CommonOptions& common) {
  require_count("--repeat", command.repeat, 1, 10000);
  if (command.most_hits) require_positive("--most-hits", *command.most_hits);
  validate::BenchRequest request{.effort = command.effort_asked(),
                                 .axes = axes_of(command),
                                 .scene_folder = scene_folder(),
                                 .techniques = techniques_of(command),
                                 .instruction_sets = command.instruction_set.sets(),
                                 .threads = common.threads,
                                 .repeats = command.repeat,
                                 .most_hits = command.most_hits,
                                 .seed = common.seed};
  if (command.embree_modes == "all") request.embree_modes = validate::all_embree_modes();
  if (command.techniques.empty()) request.costs = command.costs.request(common);
  return request;
}

validate::RegretRequest regret_request(const BenchCommand& command, const CommonOptions& common) {
  return {.effort = command.effort_asked(),
          .families = command.families,
          .scene = command.scene,
          .fields = command.fields_asked(),
          .scene_folder = scene_folder(),
          .instruction_set = command.instruction_set.only(),
          .threads = common.threads,
          .costs = command.costs.request(common),
          .seed = common.seed};
}

/// The name of each scene, or its file, in their order.
template <class NameOf>
Json scenes_json(const validate::BenchSet& set, const NameOf& name_of) {
  Json scenes = Json::array();
  for (const validate::BenchWorkload& one : set.workloads)
    if (const std::string scene = name_of(one); scenes.empty() || scenes.back() != scene) scenes.push_back(scene);
  return scenes;
}

Json inputs_json(const BenchCommand& command, const validate::RegretAnswer& answer) {
  Json json{{"regret", true},
            {"effort", command.effort},
            {"scenes", scenes_json(answer.set, [](const auto& one) { return one.scene; })},
            {"workloads", answer.set.workloads.size()},
            {"threads", answer.threads},
            {"unit_costs", to_json(answer.costs.simd)}};
  if (command.families) json["families"] = *command.families;
  return json;
}

Json inputs_json(const BenchCommand& command, const validate::BenchAnswer& answer) {
  const validate::BenchOptions& options = answer.options;
  Json json{{"effort", command.effort},
            {"scenes", scenes_json(answer.set, [](const auto& one) { return std::get<std::string>(one.discs); })},
            {"workloads", answer.set.workloads.size()},
            {"techniques", Json::array()},
            {"embree_modes", Json::array()},
            {"threads", options.threads},
            {"repeat", options.race.repeats},
            {"seconds_after_which_no_fourth_round_begins", options.race.most_seconds},
            {"most_hits", options.most_hits}};
  for (const Technique technique : exact_techniques)
    if (options.techniques.empty() || std::ranges::find(options.techniques, technique) != options.techniques.end())
      json["techniques"].push_back(name(technique));
  for (const validate::EmbreeMode& mode : options.embree_modes) json["embree_modes"].push_back(describe(mode));
  return json;
}

Result run_command_bench(const BenchCommand& command, const CommonOptions& common, const std::stop_token& stop) {
  check_regret(command);
  const auto answer_to = [&](const auto& request) {
    const ProgressLine progress(common.quiet);
    const auto answer =
        validate::answer(request, stop, progress.report(), [&](const std::string& notice) { note(common, notice); });
    Result result = report(answer, common.screen());
    result.inputs = inputs_json(command, answer);
    return result;
  };
  return command.regret ? answer_to(regret_request(command, common)) : answer_to(bench_request(command, common));
}

}  // namespace

Command bench_command(CLI::App& program) {
  CLI::App* app =
      program.add_subcommand("bench", "Our techniques and Embree on the same rays and discs, timed in turns");
  app->footer("Example: detp bench @tree --rays 1e4,1e5 --disc-radius 1%,4%\nExample: detp bench --regret");
  const auto command = std::make_shared<BenchCommand>();
  app->add_option("SCENE", command->scene, "a mesh or a built-in scene; default: the effort's set of scenes");
  app->add_option("--rays", command->rays, "a list or a range, as 1k,100k; default: the effort's");
  app->add_option("--samples", command->samples, "a list or a range; default: the scene's vertices");
  app->add_option("--disc-radius", command->disc_radii,
                  "a list of lengths or percentages, as 1%,4%; default: the effort's");
  app->add_option("--field", command->fields, "isotropic, photons or both; default: both, where there is a light")
      ->delimiter(',')
      ->check(CLI::IsMember({"isotropic", "photons"}));
  app->add_option("--effort", command->effort,
                  "quick (a minute) or thorough (half an hour), with meshes from $DETP_SCENES; default: quick")
      ->check(CLI::IsMember({"quick", "thorough"}));
  app->add_option("--techniques", command->techniques, "a list of ours; default: all exact ones")->delimiter(',');
  app->add_option("--embree-modes", command->embree_modes, "best (six of them) or all 60; default: best")
      ->check(CLI::IsMember({"best", "all"}));
  add_number(*app, "--repeat", command->repeat, "rounds, at most; medians are shown; default: 5");
  add_count(*app, "--most-hits", command->most_hits, "skip workloads with more hits; default: 1e6, thorough 5e6");
  command->instruction_set.add_to(*app, "our kernels and of Embree, a list");
  app->add_flag(
      "--regret", command->regret,
      "how much slower the chosen candidates are than the best of all, instead of a race with Embree; the effort quick "
      "takes a minute, thorough hours; SCENE and --field select some of its workloads");
  app->add_option(
      "--families", command->families,
      "with --regret: 84 workloads in scenes that this seed makes, instead of those of the effort; default: not");
  command->costs.add_to(*app);
  command->app = app;
  return {app,
          [command](const CommonOptions& common, const std::stop_token& stop) {
            return run_command_bench(*command, common, stop);
          },
          false, validate::describe_bench() + validate::describe_regret()};
}

}  // namespace detp::cli
