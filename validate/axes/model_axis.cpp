#include <cmath>
#include <optional>

#include "axes.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/effects/observe.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/choice/choice.hpp"

namespace detp::validate {
namespace {

const Prediction* box_tree_of(const Choice& choice) {
  for (const Prediction& one : choice.candidates)
    if (one.candidate.technique == Technique::box_tree) return &one;
  return nullptr;
}

/// A relative error, with the interval of the prediction's own standard error; none if that is 0, for not known.
AxisPoint compared(std::string setting, std::string quantity, double predicted, double predicted_error, double found) {
  AxisPoint point{.axis = "model", .setting = std::move(setting), .quantity = std::move(quantity)};
  point.error = std::abs(predicted / found - 1);
  const double half = 2 * predicted_error / found;
  if (half > 0) point.interval = AxisInterval{std::max(0.0, point.error - half), point.error + half};
  return point;
}

}  // namespace

std::vector<AxisPoint> model_axis(const sim::PathRays& rays, std::span<const sim::Disc> discs, const CostTable& costs,
                                  const AxisOptions& options) {
  const sim::Problem problem = sim::make_problem(rays, discs, false, sim::thread_count(options.threads), options.stop);
  std::vector<AxisPoint> points;
  for (const Rigor rigor : {Rigor::estimate, Rigor::structural, Rigor::pilot}) {
    const sim::Stopwatch watch;
    std::optional<Workload> workload;
    if (rigor == Rigor::structural) workload = sim::observe(problem).workload;
    const Choice choice =
        choose({.problem = &problem, .workload = workload, .rigor = rigor, .threads = 1, .stop = options.stop}, costs);
    const double seconds = watch.seconds();
    const Prediction* const box_tree = box_tree_of(choice);
    if (box_tree == nullptr) continue;  // ruled out
    const sim::Outcome counted = sim::run(problem, box_tree->candidate, {.stop = options.stop});
    const sim::Outcome timed = sim::run(problem, box_tree->candidate, {.count = false, .stop = options.stop});
    if (counted.stopped || timed.stopped) throw sim::Stopped("stopped during a full run");
    const auto add = [&](AxisPoint point) {
      point.seconds = seconds;
      point.work = static_cast<double>(rigor == Rigor::estimate ? 0 : choice.sampled_rays);
      points.push_back(std::move(point));
    };
    const std::string setting(name(rigor));
    add(compared(setting, "tests of a box tree", tests(box_tree->counts), tests(box_tree->counts_error),
                 static_cast<double>(tests(counted.counts))));
    add(compared(setting, "seconds of a box tree", box_tree->seconds(), box_tree->error, timed.seconds.total()));
    if (rigor == Rigor::pilot) {
      AxisPoint full{.axis = "model", .setting = "full run", .quantity = "tests of a box tree"};  // counts are exact
      full.seconds = counted.seconds.total();
      full.work = static_cast<double>(rays.rays.size());
      points.push_back(full);
    }
  }
  return points;
}

}  // namespace detp::validate
