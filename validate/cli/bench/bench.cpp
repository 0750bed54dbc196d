#include <fmt/format.h>

#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "bench_regret.hpp"
#include "bench_report.hpp"
#include "detp/sim/lists/simd/instruction_sets.hpp"
#include "detp/validate/cli/command.hpp"
#include "detp/validate/cli/options/candidate_options.hpp"
#include "detp/validate/cli/options/instruction_set_option.hpp"
#include "detp/validate/cli/options/value_lists.hpp"
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
  RegretCommand regret;
};

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
                           .fields = {},
                           .samples = counts_of("--samples", command.samples),
                           .disc_radii = {},
                           .rays = counts_of("--rays", command.rays)};
  if (!command.disc_radii.empty())
    for (const std::string& radius : values_of("--disc-radius", command.disc_radii))
      axes.disc_radii.push_back(validate::parse_length(radius));
  for (const std::string& field : command.fields)
    axes.fields.push_back(field == "photons" ? sim::Field::photons : sim::Field::isotropic);
  return axes;
}

std::vector<Technique> techniques_of(const BenchCommand& command) {
  std::vector<Technique> techniques;
  for (const std::string& text : command.techniques) {
    CandidateOptions named;
    named.technique = text;
    const Technique technique = named.technique_or(Technique::brute_force);
    if (!record_of(technique).exact)
      throw std::invalid_argument(text + " does not find all hits; bench compares exact techniques only");
    techniques.push_back(technique);
  }
  return techniques;
}

std::vector<int> threads_of(const CommonOptions& common) {
  if (common.threads > 0) return {common.threads};
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  return cores > 1 ? std::vector{1, cores} : std::vector{1};
}

validate::BenchOptions options_of(const BenchCommand& command, const CommonOptions& common, std::stop_token stop,
                                  const ProgressLine& progress) {
  require_count("--repeat", command.repeat, 1, 10000);
  if (command.most_hits) require_positive("--most-hits", *command.most_hits);
  const bool thorough = command.effort == "thorough";
  return {.techniques = techniques_of(command),
          .embree_modes = command.embree_modes == "all" ? validate::all_embree_modes() : validate::best_embree_modes(),
          .costs = command.techniques.empty() ? std::optional(command.regret.costs(common).simd) : std::nullopt,
          .threads = threads_of(common),
          .repeats = command.repeat,
          .most_seconds = thorough ? 2.0 : 0.5,
          .most_hits = command.most_hits.value_or(thorough ? 5e6 : 1e6),
          .seed = common.seed,
          .stop = std::move(stop),
          .progress = progress.report()};
}

Json inputs_json(const BenchCommand& command, const validate::BenchSet& set, const validate::BenchOptions& options) {
  Json json{{"effort", command.effort},          {"scenes", Json::array()},
            {"workloads", set.workloads.size()}, {"techniques", Json::array()},
            {"embree_modes", Json::array()},     {"threads", options.threads},
            {"repeat", options.repeats},         {"seconds_after_which_no_fourth_round_begins", options.most_seconds},
            {"most_hits", options.most_hits}};
  for (const validate::BenchWorkload& workload : set.workloads)
    if (json["scenes"].empty() || json["scenes"].back() != workload.path) json["scenes"].push_back(workload.path);
  for (const Technique technique : exact_techniques)
    if (options.techniques.empty() ||
        std::find(options.techniques.begin(), options.techniques.end(), technique) != options.techniques.end())
      json["techniques"].push_back(name(technique));
  for (const validate::EmbreeMode& mode : options.embree_modes) json["embree_modes"].push_back(describe(mode));
  return json;
}

Result run_command_bench(const BenchCommand& command, const CommonOptions& common, const std::stop_token& stop) {
  if (command.regret.is_wanted()) {
    const std::string only = command.instruction_set.only();
    std::optional<sim::stream::OnlyInstructionSet> used;
    if (!only.empty()) used.emplace(only);
    return run_bench_regret(command.regret, command.effort, command.scene, command.fields, common, stop);
  }
  const char* folder = std::getenv("DETP_SCENES");
  const auto effort = command.effort == "thorough" ? validate::BenchEffort::thorough : validate::BenchEffort::quick;
  const validate::BenchSet set = validate::bench_set(effort, axes_of(command), folder != nullptr ? folder : "");
  const ProgressLine progress(common.quiet);
  std::vector<validate::BenchResult> benches;
  validate::BenchOptions options;
  for (const std::string& instruction_set : command.instruction_set.sets()) {
    {
      std::optional<sim::stream::OnlyInstructionSet> used;  // whose unit costs are looked for
      if (!instruction_set.empty()) used.emplace(instruction_set);
      options = options_of(command, common, stop, progress);
    }
    options.instruction_set = instruction_set;
    benches.push_back(validate::run_bench(set.workloads, options));
  }
  Result result = report_bench(benches, options, set.missing, common.screen());
  result.inputs = inputs_json(command, set, options);
  return result;
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
  command->regret.add_to(*app);
  return {app, [command](const CommonOptions& common, const std::stop_token& stop) {
            return run_command_bench(*command, common, stop);
          }};
}

}  // namespace detp::cli
