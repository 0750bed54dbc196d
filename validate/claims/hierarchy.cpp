#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "batches.hpp"
#include "detp/model/rank/predict.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/base/search_work.hpp"
#include "detp/validate/structural/structural.hpp"
#include "experiments.hpp"

namespace detp::validate {
namespace {

constexpr double hierarchy_tolerance = 0.025;

struct Quantity {
  std::string_view id;          ///< ends the id of the claim about the closed form
  std::string_view structural;  ///< ends the id of the claim about the structural counts
  std::string_view what;        ///< the count in words
  double Counts<double>::*term;
  bool per_line = true;  ///< true: proportional to the number of lines; false: counted on few_lines of the lines
};

struct Subject {
  Technique technique;
  std::string id;
  Engine engine;
  std::vector<Candidate> candidates;
  std::string over;         ///< the candidates, in words; observations and predictions are means over them
  std::string_view source;  ///< source of the closed form
  std::string_view bodies;  ///< "spheres" or "boxes": the structural counts are sums over their areas
  std::vector<Quantity> quantities;
};

constexpr Quantity sphere_tests{"sphere-tests", "sphere-structural", "ray-sphere tests", &Counts<double>::cull_tests};
constexpr Quantity box_tests{"box-tests", "box-structural", "ray-box tests", &Counts<double>::cull_tests};
constexpr Quantity disc_tests{"disc-tests", "disc-structural", "ray-disc tests", &Counts<double>::disc_tests};
constexpr Quantity listed{"listed-rays", "listed-structural", "rays listed", &Counts<double>::listed};
constexpr Quantity nodes{"nodes-visited", "nodes-structural", "nodes visited", &Counts<double>::culls, false};
constexpr Quantity discs_visited{"discs-visited", "visits-structural", "discs visited", &Counts<double>::visits, false};

Subject cell_spheres_subject(const Workload& workload) {
  // The deepest level whose cells are at least as wide as a disc; at most the curve's 16 levels.
  const double halvings = std::floor(std::log2(scene_side(workload) / (2 * workload.disc_radius)));
  const int deepest = static_cast<int>(std::clamp(halvings, 2.0, 16.0));
  return {Technique::cell_spheres,
          "cell-spheres",
          Engine::plain,
          {{Technique::cell_spheres, CellSpheresParameters{deepest - 1}},
           {Technique::cell_spheres, CellSpheresParameters{deepest}}},
          fmt::format("geometric mean over depth {} and {}", deepest - 1, deepest),
          "r_i^2/r_0^2 times occupied cells, our derivation",
          "spheres",
          {sphere_tests, disc_tests}};
}

Subject sphere_tree_subject() {
  return {Technique::sphere_tree,
          "sphere-tree",
          Engine::plain,
          {{Technique::sphere_tree, SphereTreeParameters{8, 8}}, {Technique::sphere_tree, SphereTreeParameters{4, 16}}},
          "geometric mean over 8 children a node, 8 samples a leaf and 4 and 16",
          "tabulated spheres of runs, our derivation",
          "spheres",
          {sphere_tests, disc_tests}};
}

/// Trees of four children a node, with 8 and 16 discs in a leaf.
Subject box_tree_subject(Engine engine) {
  return {Technique::box_tree,
          fmt::format("box-tree-{}", name(engine)),
          engine,
          {{Technique::box_tree, BoxTreeParameters{4, 8}}, {Technique::box_tree, BoxTreeParameters{4, 16}}},
          fmt::format("{} engine, geometric mean over 8 and 16 samples a leaf, 4 children a node", name(engine)),
          "mean boxes of cells, our derivation",
          "boxes",
          {box_tests, disc_tests, listed, nodes, discs_visited}};
}

std::vector<Subject> all_subjects(const Workload& workload) {
  return {cell_spheres_subject(workload), sphere_tree_subject(), box_tree_subject(Engine::plain),
          box_tree_subject(Engine::simd)};
}

/// Share of the lines on which nodes and visits are counted. With all lines, hardly any list would be empty, and the
/// claims would be trivial.
constexpr double few_lines = 0.125;

/// For each quantity the mean logarithms over a subject's candidates of what one set counts and of its predictions. Columns of a set's numbers.
enum class Source : std::size_t { counted, closed, structural };
std::size_t place_of(const Subject& subject, Source source, std::size_t quantity) {
  return static_cast<std::size_t>(source) * subject.quantities.size() + quantity;
}

Workload workload_of(const Experiment& experiment, const sim::Problem& problem) {
  Workload workload = experiment.workload;
  workload.rays = static_cast<double>(problem.rays().size());
  workload.sphere_radius = problem.enclosing().radius;
  return workload;
}

/// Adds the numbers of the quantities whose `per_line` equals the argument. Returns false if a stop was requested.
bool run_lines(const Experiment& experiment, const Subject& subject, const sim::Problem& problem, bool per_line,
               std::vector<double>& numbers) {
  const auto lines = static_cast<double>(problem.rays().size());
  for (const Candidate& candidate : subject.candidates) {
    const sim::Outcome outcome = sim::run(problem, candidate, {.engine = subject.engine, .stop = experiment.stop});
    if (outcome.stopped) return false;
    const auto add = [&](Source source, const Counts<double>& counts) {
      for (std::size_t i = 0; i < subject.quantities.size(); ++i)
        if (const Quantity& quantity = subject.quantities[i]; quantity.per_line == per_line)
          numbers[place_of(subject, source, i)] +=
              std::log(counts.*quantity.term / lines) / static_cast<double>(subject.candidates.size());
    };
    add(Source::counted, as_expected(outcome.counts));
    add(Source::closed, model::predict(workload_of(experiment, problem), candidate, subject.engine));
    add(Source::structural, structural_counts(problem, lines, candidate, experiment.stop, false, subject.engine));
  }
  return true;
}

bool all_per_line(const Subject& subject) { return std::ranges::all_of(subject.quantities, &Quantity::per_line); }

std::vector<double> run_set(const Experiment& experiment, const Subject& subject, std::size_t lines, int set) {
  std::vector<double> numbers(3 * subject.quantities.size());
  const std::vector<sim::Disc> discs = sample_discs(experiment, set);
  const auto rays =
      sim::LineField(sim::enclosing_sphere(discs), batch_seed(experiment, 31, set)).lines(0, lines, experiment.stop);
  if (!run_lines(experiment, subject, sim::make_problem(rays, discs), true, numbers)) return {};
  const auto few = static_cast<std::size_t>(std::ceil(few_lines * static_cast<double>(lines)));
  const std::span<const sim::Ray> some(rays.data(), few);
  if (!all_per_line(subject) && !run_lines(experiment, subject, sim::make_problem(some, discs), false, numbers))
    return {};
  return numbers;
}

Finding closed_finding(const Subject& subject, const BatchNumbers& sets, std::size_t i) {
  const Quantity& quantity = subject.quantities[i];
  const double predicted = geometric_mean_of(sets, place_of(subject, Source::closed, i)).mean;
  return {.id = fmt::format("{}-{}", subject.id, quantity.id),
          .quantity = fmt::format("{} per line{} of {}: {}", quantity.what, quantity.per_line ? "" : ", few lines",
                                  name(subject.technique), subject.over),
          .predictions = {{Form::corrected, std::string(subject.source), predicted}},
          .observed = geometric_mean_of(sets, place_of(subject, Source::counted, i))};
}

Finding structural_finding(const Subject& subject, const BatchNumbers& sets, std::size_t i) {
  const Quantity& quantity = subject.quantities[i];
  return {.id = fmt::format("{}-{}", subject.id, quantity.structural),
          .quantity =
              fmt::format("{} of {}, counted over those from its {} alone", quantity.what, subject.id, subject.bodies),
          .predictions = {{Form::corrected, fmt::format("areas of nested {}, our derivation", subject.bodies), 1}},
          .observed =
              geometric_mean_of(sets, place_of(subject, Source::counted, i), place_of(subject, Source::structural, i))};
}

}  // namespace

std::vector<Finding> hierarchy_findings(const Experiment& experiment) {
  const std::size_t lines = share_of_rays(experiment);
  std::vector<Finding> findings;
  for (const Subject& subject : all_subjects(experiment.workload)) {
    const sim::Stopwatch clock;
    const auto sets = for_each_batch(experiment, [&](int set) { return run_set(experiment, subject, lines, set); });
    if (experiment.stop.stop_requested()) return {};
    std::vector<Finding> found;
    for (std::size_t i = 0; i < subject.quantities.size(); ++i) found.push_back(closed_finding(subject, sets, i));
    for (std::size_t i = 0; i < subject.quantities.size(); ++i) found.push_back(structural_finding(subject, sets, i));
    for (Finding& finding : completed(std::move(found), {name(subject.technique), hierarchy_tolerance, lines, clock}))
      findings.push_back(std::move(finding));
  }
  return findings;
}

double hierarchy_work(const Experiment& experiment) {
  double work = 0;
  for (const Subject& subject : all_subjects(experiment.workload)) {
    const int runs = all_per_line(subject) ? 1 : 2;
    for (const Candidate& candidate : subject.candidates)
      // Building a hierarchy and computing its structural counts takes about 40 units of work for each disc.
      work += test_work(model::predict(experiment.workload, candidate, subject.engine), subject.engine) +
              40.0 * runs * batch_count * experiment.workload.samples;
  }
  return work;
}

}  // namespace detp::validate
