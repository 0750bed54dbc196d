// Does the choice hold on other machines? Calibrates and judges it with each instruction set that this machine has.
//
//   cmake --build build --target instruction_sets && build/instruction_sets [SCENE ...] > instruction_sets.csv
//
// For each instruction set: unit costs by `calibrate`, then the regret of each tier (`detp bench --regret`, one thread,
// the workloads of the effort `thorough`) on the scenes, @cornell unless named. `costs` says whose unit costs a tier used:
// its own, or those of the machine's best instruction set, as if nobody had calibrated. The best constant box tree is that
// of these workloads. Some five minutes for each instruction set.

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <string>
#include <vector>

#include "detp/sim/lists/simd/instruction_sets.hpp"
#include "detp/validate/calibration/calibrate.hpp"
#include "detp/validate/regret/regret.hpp"
#include "detp/validate/regret/regret_summary.hpp"

namespace {

using namespace detp;

std::vector<validate::RegretWorkload> workloads_of(const std::vector<std::string>& scenes) {
  const char* folder = std::getenv("DETP_SCENES");
  auto all = validate::regret_set(validate::RegretEffort::thorough, folder != nullptr ? folder : "").workloads;
  std::erase_if(all, [&](const validate::RegretWorkload& one) {
    return std::find(scenes.begin(), scenes.end(), one.scene) == scenes.end();
  });
  for (validate::RegretWorkload& one : all) one.held_out = false;  // one half, so that the best constant is theirs
  return all;
}

void print(const std::string& set, const std::string& tier, const std::string& costs, const validate::Figures& regret,
           const validate::PredictionFigures& prediction) {
  fmt::print("{},{},{},{},{:.3f},{:.3f},{:.3f},", set, tier, costs, regret.rows, regret.geometric_mean, regret.p95,
             regret.worst);
  if (prediction.rows > 0) fmt::print("{:.3f},{:.3f}", prediction.median_error, prediction.p95_error);
  if (prediction.rows == 0) fmt::print(",");
  fmt::print("\n");
}

void judge(const std::string& set, const std::vector<validate::RegretWorkload>& workloads, const CostTable& own,
           const CostTable& others) {
  std::vector<validate::Chooser> choosers = validate::all_choosers(own);
  const std::size_t tiers = choosers.size();
  std::ranges::move(validate::all_choosers(others), std::back_inserter(choosers));
  const auto rows = validate::run_regret(workloads, choosers, {.costs = own}).rows;
  const validate::RegretSummary summary = validate::summarise(rows, 1);
  for (std::size_t i = 0; i < choosers.size(); ++i)
    print(set, choosers[i].name, i < tiers ? "own" : "best set's", summary.tiers[i].regret.all,
          summary.tiers[i].prediction);
  print(set, "best constant", "", summary.baselines.front().regret.all, {});
  print(set, "noise", "", summary.noise, {});
}

}  // namespace

int main(int argc, char** argv) {
  const auto workloads =
      workloads_of(argc > 1 ? std::vector<std::string>(argv + 1, argv + argc) : std::vector<std::string>{"@cornell"});
  std::vector<CostTable> costs;
  fmt::print("instruction_set,tier,costs,workloads,geometric_mean,p95,worst,median_error,p95_error\n");
  for (const auto& set : sim::stream::compiled_instruction_sets()) {
    if (!set.here) {
      fmt::print(stderr, "{}: this machine lacks it\n", set.name);
      continue;
    }
    const sim::stream::OnlyInstructionSet only(set.name);
    const validate::Calibration calibration = validate::calibrate({.threads = 1});
    fmt::print(stderr, "{}: median error of left-out workloads {:.3f}\n", set.name, calibration.left_out_median_error);
    costs.push_back(calibration.simd.costs);
    judge(set.name, workloads, costs.back(), costs.front());
    std::fflush(stdout);
  }
}
