#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "detp/model/rank/predict.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/base/search_work.hpp"
#include "detp/validate/structural/structural.hpp"
#include "experiments.hpp"
#include "samples.hpp"

namespace detp::validate {
namespace {

constexpr double tolerance = 0.025;

/// The claims about one technique.
struct Subject {
  std::string_view id;
  std::vector<Candidate> candidates;
  std::string over;         ///< the candidates that the mean is over
  std::string_view source;  ///< source of the closed form
};

Subject cell_spheres(const Workload& workload) {
  // Down to the smallest cells that a disc fits in, within the resolution of the curve.
  const double halvings = std::floor(std::log2(scene_side(workload) / (2 * workload.disc_radius)));
  const int deepest = static_cast<int>(std::clamp(halvings, 2.0, 16.0));
  Subject subject{"cell-spheres",
                  {},
                  fmt::format("geometric mean over depth {} and {}", deepest - 1, deepest),
                  "r_i^2/r_0^2 times occupied cells, our derivation"};
  for (const int depth : {deepest - 1, deepest})
    subject.candidates.push_back({Technique::cell_spheres, CellSpheresParameters{depth}});
  return subject;
}

Subject sphere_tree() {
  Subject subject{"sphere-tree",
                  {},
                  "geometric mean over 8 children a node, 8 samples a leaf and 4 and 16",
                  "tabulated spheres of runs, our derivation"};
  for (const auto& parameters : {SphereTreeParameters{8, 8}, SphereTreeParameters{4, 16}})
    subject.candidates.push_back({Technique::sphere_tree, parameters});
  return subject;
}

/// Mean logarithms over the candidates, of sphere tests and disc tests per ray.
struct Logs {
  double cull_tests = 0;
  double disc_tests = 0;

  void add(const Counts<double>& counts, double rays, std::size_t candidates) {
    cull_tests += std::log(counts.cull_tests / rays) / static_cast<double>(candidates);
    disc_tests += std::log(counts.disc_tests / rays) / static_cast<double>(candidates);
  }
};

/// The results of one set of samples and lines.
struct SetResult {
  Logs counted, closed, structural;
};

/// The workload with the actual S₀ of this set of samples.
Workload workload_of(const Experiment& experiment, const sim::Problem& problem) {
  Workload workload = experiment.workload;
  workload.sphere_radius = problem.enclosing.radius;
  return workload;
}

SetResult run_set(const Experiment& experiment, const Subject& subject, std::size_t lines, int set) {
  SetResult result;
  const std::vector<sim::Disc> discs = sample_discs(experiment, set);
  const auto rays =
      sim::LineField(sim::enclosing_sphere(discs), batch_seed(experiment, 31, set)).lines(0, lines, experiment.stop);
  const sim::Problem problem = sim::make_problem(rays, discs);
  const auto count = static_cast<double>(lines);
  const std::size_t all = subject.candidates.size();
  for (const Candidate& candidate : subject.candidates) {
    const sim::Outcome outcome = sim::run(problem, candidate, {.engine = Engine::plain, .stop = experiment.stop});
    if (outcome.stopped) return {};
    result.counted.add(as_expected(outcome.counts), count, all);
    result.closed.add(model::predict(workload_of(experiment, problem), candidate, Engine::plain),
                      experiment.workload.rays, all);
    result.structural.add(structural_counts(problem, count, candidate, experiment.stop), count, all);
  }
  return result;
}

using Column = Logs SetResult::*;
using Term = double Logs::*;

double geometric_mean(const std::vector<SetResult>& sets, Column column, Term term) {
  double sum = 0;
  for (const SetResult& set : sets) sum += set.*column.*term;
  return std::exp(sum / static_cast<double>(sets.size()));
}

/// Geometric mean of the counts, divided by `below` if set. The standard error between sets is computed for the
/// logarithm, and converted.
Estimate counted(const std::vector<SetResult>& sets, Term term, Column below = nullptr) {
  std::vector<double> logs;
  for (const SetResult& set : sets) logs.push_back(set.counted.*term - (below == nullptr ? 0 : set.*below.*term));
  const Estimate log = batch_means(logs);
  return {std::exp(log.mean), std::exp(log.mean) * log.standard_error};
}

Finding closed_finding(const Subject& subject, const std::vector<SetResult>& sets, Term term, std::string_view what) {
  return {
      .id = fmt::format("{}-{}-tests", subject.id, what),
      .quantity = fmt::format("ray-{} tests per line of {}: {}", what, subject.id, subject.over),
      .predictions = {{Form::corrected, std::string(subject.source), geometric_mean(sets, &SetResult::closed, term)}},
      .observed = counted(sets, term),
      .batches = batch_count,
      .tolerance = tolerance};
}

Finding structural_finding(const Subject& subject, const std::vector<SetResult>& sets, Term term,
                           std::string_view what) {
  return {.id = fmt::format("{}-{}-structural", subject.id, what),
          .quantity = fmt::format("ray-{} tests of {}, counted over those from its spheres alone", what, subject.id),
          .predictions = {{Form::corrected, "areas of nested spheres, our derivation", 1}},
          .observed = counted(sets, term, &SetResult::structural),
          .batches = batch_count,
          .tolerance = tolerance};
}

}  // namespace

std::vector<Finding> sphere_hierarchy_findings(const Experiment& experiment) {
  const std::size_t lines =
      std::max<std::size_t>(100, static_cast<std::size_t>(experiment.workload.rays) / batch_count);
  std::vector<Finding> findings;
  for (const Subject& subject : {cell_spheres(experiment.workload), sphere_tree()}) {
    const sim::Stopwatch clock;
    const auto sets = for_each_batch(experiment, [&](int set) { return run_set(experiment, subject, lines, set); });
    if (experiment.stop.stop_requested()) return {};
    std::vector<Finding> found;
    found.push_back(closed_finding(subject, sets, &Logs::cull_tests, "sphere"));
    found.push_back(closed_finding(subject, sets, &Logs::disc_tests, "disc"));
    found.push_back(structural_finding(subject, sets, &Logs::cull_tests, "sphere"));
    found.push_back(structural_finding(subject, sets, &Logs::disc_tests, "disc"));
    for (Finding& finding : found) {
      finding.technique = subject.id;
      finding.lines = lines * batch_count;
      finding.seconds = clock.seconds();
      findings.push_back(std::move(finding));
    }
  }
  return findings;
}

double sphere_hierarchy_work(const Experiment& experiment) {
  double work = 0;
  for (const Subject& subject : {cell_spheres(experiment.workload), sphere_tree()})
    for (const Candidate& candidate : subject.candidates)
      // The structures are built and looked at with some 40 units for a disc.
      work += test_work(model::predict(experiment.workload, candidate, Engine::plain), Engine::plain) +
              40.0 * batch_count * experiment.workload.samples;
  return work;
}

}  // namespace detp::validate
