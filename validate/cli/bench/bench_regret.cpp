#include "bench_regret.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "detp/model/vocabulary/nearest_name.hpp"
#include "detp/model/vocabulary/quoted.hpp"
#include "detp/validate/cli/options/unit_cost_option.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/progress_line.hpp"
#include "regret_report.hpp"

namespace detp::cli {
namespace {

using validate::RegretWorkload;

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

}  // namespace

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

}  // namespace detp::cli
