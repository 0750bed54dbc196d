#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "bench_report.hpp"
#include "detp/model/vocabulary/nearest_name.hpp"
#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/lists/simd/instruction_sets.hpp"
#include "detp/validate/cli/command.hpp"
#include "detp/validate/cli/options/candidate_options.hpp"
#include "detp/validate/cli/options/cost_options.hpp"
#include "detp/validate/cli/options/value_lists.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/progress_line.hpp"

namespace detp::cli {
namespace {

using validate::RegretWorkload;

/// The options of `bench --regret`.
class RegretCommand {
 public:
  /// Adds --regret, --families, --costs and --calibration.
  void add_to(CLI::App& bench);

  /// Whether --regret was given. Throws std::invalid_argument if options were given that it excludes.
  [[nodiscard]] bool is_wanted() const;

  /// Seed of the families of scenes that replace the other workloads.
  [[nodiscard]] std::optional<std::uint64_t> families() const { return families_; }
  [[nodiscard]] CostsInUse costs(const CommonOptions& common) const { return costs_.costs(common); }

 private:
  bool wanted_ = false;
  std::optional<std::uint64_t> families_;
  CostOptions costs_;
  const CLI::App* bench_ = nullptr;
};

/// Leaves only the workloads of this scene.
void keep_scene(std::vector<RegretWorkload>& workloads, const std::string& scene) {
  std::vector<std::string_view> names;
  for (const RegretWorkload& one : workloads)
    if (names.empty() || names.back() != one.scene) names.emplace_back(one.scene);
  if (std::find(names.begin(), names.end(), scene) == names.end())
    throw std::invalid_argument(fmt::format("bench --regret has no scene {} at this effort; there are {}{}",
                                            detp::quoted(scene), fmt::join(names, ", "), did_you_mean(scene, names)));
  std::erase_if(workloads, [&](const RegretWorkload& one) { return one.scene != scene; });
}

void keep_fields(std::vector<RegretWorkload>& workloads, const std::vector<std::string>& fields) {
  std::erase_if(workloads, [&](const RegretWorkload& one) {
    return std::find(fields.begin(), fields.end(), name(one.field)) == fields.end();
  });
  if (workloads.empty())
    throw std::invalid_argument(fmt::format("no workload of these scenes has the field {}", fmt::join(fields, ",")));
}

Json inputs_json(const std::vector<RegretWorkload>& workloads, const std::string& effort, const CostTable& costs,
                 const std::vector<int>& threads) {
  Json json{{"regret", true},          {"effort", effort},
            {"scenes", Json::array()}, {"workloads", workloads.size()},
            {"threads", threads},      {"unit_costs", to_json(costs)}};
  for (const RegretWorkload& one : workloads)
    if (json["scenes"].empty() || json["scenes"].back() != one.scene) json["scenes"].push_back(one.scene);
  return json;
}

void RegretCommand::add_to(CLI::App& bench) {
  bench_ = &bench;
  bench.add_flag(
      "--regret", wanted_,
      "how much slower the chosen candidates are than the best of all, instead of a race with Embree; the effort quick "
      "takes a minute, thorough hours; SCENE and --field select some of its workloads");
  bench.add_option(
      "--families", families_,
      "with --regret: 84 workloads in scenes that this seed makes, instead of those of the effort; default: not");
  costs_.add_to(bench);
}

bool RegretCommand::is_wanted() const {
  const auto is_given = [&](const char* option) { return bench_->get_option(option)->count() > 0; };
  for (const char* option :
       {"--rays", "--samples", "--disc-radius", "--techniques", "--embree-modes", "--repeat", "--most-hits"})
    if (wanted_ && is_given(option))
      throw std::invalid_argument(fmt::format(
          "{} and --regret exclude each other; SCENE, --field and --effort select the workloads of --regret", option));
  if (families_ && !wanted_) throw std::invalid_argument("--families belongs to --regret");
  return wanted_;
}

/// The regret of the choices over the workloads of the effort: "quick" or "thorough". With a scene or fields, only over
/// those of them. Throws std::invalid_argument if there are none.
Result run_bench_regret(const RegretCommand& command, const std::string& effort,
                        const std::optional<std::string>& scene, const std::vector<std::string>& fields,
                        const CommonOptions& common, const std::stop_token& stop) {
  const bool thorough = effort == "thorough";
  const char* folder = std::getenv("DETP_SCENES");
  validate::RegretSet set =
      command.families()
          ? validate::RegretSet{validate::family_workloads(*command.families()), {}}
          : validate::regret_set(thorough ? validate::RegretEffort::thorough : validate::RegretEffort::quick,
                                 folder != nullptr ? folder : "");
  if (scene) keep_scene(set.workloads, *scene);
  if (!fields.empty()) keep_fields(set.workloads, fields);
  const CostsInUse costs = command.costs(common);
  const ProgressLine progress(common.quiet);
  validate::RegretOptions options{.costs = costs.simd,
                                  .threads = std::max(1, common.threads),
                                  .seed = common.seed,
                                  .stop = stop,
                                  .progress = progress.report()};
  if (thorough && common.threads == 0 && std::thread::hardware_concurrency() > 1) options.more_threads = 2;
  std::vector<int> threads{options.threads};
  if (options.more_threads > 0) threads.push_back(options.more_threads);
  const validate::RegretResult regret =
      validate::run_regret(set.workloads, validate::all_choosers(costs.simd), options);
  Result result = report_regret(regret, threads, set.missing, common.screen());
  result.inputs = inputs_json(set.workloads, effort, costs.simd, threads);
  if (command.families()) result.inputs["families"] = *command.families();
  result.json["unit_costs"] = costs.origin;
  result.text += wrapped("costs     " + costs.origin, common.screen().text_width(), 10);
  return result;
}

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
