#include <fmt/format.h>

#include <cmath>

#include "batches.hpp"
#include "counted_search.hpp"
#include "detp/model/rank/predict.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/validate/base/search_work.hpp"
#include "experiments.hpp"

namespace detp::validate {
namespace {

/// See the figures in the README of this folder.
constexpr double effects_tolerance = 0.5;

/// A usual box tree: `detp scene` shows for it what switching an effect changes.
Candidate usual_tree() { return {Technique::box_tree, BoxTreeParameters{8, 16}}; }

double all_tests(const Counts<double>& counts) { return counts.cull_tests + counts.disc_tests; }

double all_hits(const Counts<double>& counts) { return counts.hits; }

}  // namespace

std::vector<Finding> effect_findings(const Experiment& experiment) {
  if (!experiment.choice || experiment.stop.stop_requested()) return {};
  const sim::Stopwatch clock;
  const ChoiceQuestion& question = *experiment.choice;
  const auto counted = count_search(experiment, usual_tree());
  if (!counted) return {};
  const Counts<double> predicted = model::predict(question.workload, usual_tree());
  const std::string with = question.effects.empty() ? "no effect" : question.effects;
  std::vector<Finding> findings;
  const auto add = [&](const char* id, const char* what, double (*value)(const Counts<double>&)) {
    const Estimate found = observed_in(*counted, value, value(predicted), question.workload.rays);
    findings.push_back({.id = fmt::format("effects.{}", id),
                        .quantity = fmt::format("{} of {} {}, predicted with {}", what, name(Technique::box_tree),
                                                describe(usual_tree()), with),
                        .technique = std::string(name(Technique::box_tree)),
                        .parameters = describe(usual_tree()),
                        .predictions = {{Form::corrected, "the closed form with these effects", value(predicted)}},
                        .observed = found,
                        .batches = batches_in(*counted),
                        .tolerance = effects_tolerance,
                        .lines = static_cast<std::uint64_t>(counted->all.rays)});
  };
  add("tests", "tests of rays with boxes and discs", all_tests);
  add("hits", "hits", all_hits);
  for (Finding& finding : findings) finding.seconds = clock.seconds();
  return findings;
}

double effect_work(const Experiment& experiment) {
  if (!experiment.choice) return 0;
  const Counts<double> counts = model::predict(experiment.choice->workload, usual_tree());
  return 2 * test_work(counts) + (1 + batch_count) * build_work(counts);
}

}  // namespace detp::validate
