#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "batches.hpp"
#include "detp/model/disc_index/disc_index.hpp"
#include "detp/model/disc_index/disc_index_published.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/sim/geometry/ray_box.hpp"
#include "detp/sim/index/indexed_search.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/base/search_work.hpp"
#include "detp/validate/structural/structural.hpp"
#include "experiments.hpp"

namespace detp::validate {
namespace {

constexpr double index_tolerance = 0.02;
constexpr std::size_t lines_through_cells = 20'000;  ///< of each batch

/// The numbers that a batch counts.
struct Counted {
  enum : std::size_t {
    lines,
    hitting,     ///< lines that hit the index's cube
    steps,       ///< of a grid
    disc_tests,  ///< of an octree
    hits
  };
};

int tested_depth(const Workload& workload) {
  return std::clamp(model::published::octree_depth({workload.disc_radius}, scene_side(workload)), 1, 7);
}

double lines_that_hit(const std::vector<sim::Ray>& lines, const sim::Box& box) {
  return static_cast<double>(std::count_if(
      lines.begin(), lines.end(), [&](const sim::Ray& line) { return !sim::ClippedRay(line).inside(box).empty(); }));
}

/// The cube that an octree subdivides: the index's box, with all sides made as long as the longest.
sim::Box index_cube(const std::vector<sim::Disc>& discs) {
  const sim::Box box = sim::index_box(discs);
  const glm::dvec3 size = box.size();
  return {box.low, box.low + std::max({size.x, size.y, size.z})};
}

/// Of each batch.
BatchNumbers count_batches(const Experiment& experiment, const std::vector<sim::Disc>& discs,
                           const Candidate& candidate, int part, std::size_t count) {
  return for_each_batch(experiment, [&](int batch) {
    const auto lines = sim::LineField(sim::enclosing_sphere(discs), batch_seed(experiment, part, batch))
                           .lines(0, count, experiment.stop);
    const sim::Outcome outcome = sim::run(sim::make_problem(lines, discs), candidate, {.stop = experiment.stop});
    return std::vector{static_cast<double>(count), lines_that_hit(lines, index_cube(discs)),
                       static_cast<double>(outcome.counts.steps), static_cast<double>(outcome.counts.disc_tests),
                       static_cast<double>(outcome.total_hits)};
  });
}

Estimate ratio(const BatchNumbers& batches, std::size_t above, std::size_t below) {
  std::vector<double> numerators;
  std::vector<double> denominators;
  for (const std::vector<double>& batch : batches) {
    numerators.push_back(batch[above]);
    denominators.push_back(batch[below]);
  }
  return batch_ratio(numerators, denominators);
}

/// Cells per line, counted on a grid over two small discs in opposite corners of a cube.
std::vector<Finding> cells_findings(const Experiment& experiment) {
  const sim::Stopwatch clock;
  const std::size_t lines = lines_per_batch(experiment, lines_through_cells);
  const int depth = tested_depth(experiment.workload);
  const std::vector<sim::Disc> corners{{.centre = glm::dvec3{-1}, .radius = 1e-3},
                                       {.centre = glm::dvec3{1}, .radius = 1e-3}};
  const auto batches = count_batches(experiment, corners, {Technique::grid, GridParameters{1 << depth}}, 20, lines);
  const double cells = model::published::cells_per_line(depth);
  return completed(
      {{.id = "cells-per-line",
        .quantity = fmt::format("cells of a 2^{} grid crossed by a line that hits its cube", depth),
        .predictions = {{Form::published, "section 4.2", cells}, {Form::corrected, "section 4.2, unchanged", cells}},
        .observed = ratio(batches, Counted::steps, Counted::hitting)}},
      {name(Technique::grid), index_tolerance, lines, clock});
}

/// Raises the standard error to √(μ/N) if it is less: that of independent events, μ per line (predicted), on N lines.
/// Rare events may occur in no batch, and the standard error between the batches is then 0.
void allow_for_rare_events(Finding& finding) {
  const double least = std::sqrt(finding.predictions.back().value / static_cast<double>(finding.lines));
  finding.observed.standard_error = std::max(finding.observed.standard_error, least);
}

/// Uniform samples' cube lies inside S₀: the closed form predicts the tests per line that hits the cube.
///
/// For a scene it predicts the tests per line through S₀. The cube of a flat scene extends outside S₀, so fewer lines hit the cube than its area
/// predicts. The paper's tests per line that hits the cube are multiplied by P(line hits the cube).
Finding tests_finding(const Experiment& experiment, const std::vector<sim::Disc>& discs, const BatchNumbers& batches,
                      int depth) {
  const Workload& workload = experiment.workload;
  const double published = model::published::tests_per_line(workload.samples, depth);
  const bool uniform = experiment.discs.empty();
  Finding finding{.id = "octree-tests-per-line",
                  .quantity = fmt::format("ray-disc tests per line {}, octree of depth {}",
                                          uniform ? "that hits the cube" : "through S0", depth),
                  .technique = std::string(name(Technique::octree)),
                  .observed = ratio(batches, Counted::disc_tests, uniform ? Counted::hitting : Counted::lines)};
  if (uniform) {
    const double overlapped = model::index_cells(workload, std::ldexp(1.0, depth)).overlapped;
    finding.predictions = {{Form::published, "eq (22), n_P / 4^k", published},
                           {Form::corrected, "n_P E(d/a) / 4^k, our derivation",
                            workload.samples * overlapped / std::ldexp(1.0, 2 * depth)}};
    return finding;
  }
  const double side = index_cube(discs).size().x;
  const double radius = sim::enclosing_sphere(discs).radius;
  const double per_cube = 1.5 / std::numbers::pi * side * side / (radius * radius);
  finding.predictions = {{Form::published, "eq (22), n_P / 4^k, times P(cube)", published * per_cube},
                         {Form::corrected, "n_P E(d/a) P(cell), our derivation",
                          model::octree_counts(workload, {depth}).disc_tests / workload.rays}};
  return finding;
}

Finding structural_tests(const std::vector<sim::Disc>& discs, const BatchNumbers& batches, int depth) {
  const Counts<double> expected = structural_counts(discs, 1, {Technique::octree, OctreeParameters{depth}});
  return {.id = "octree-tests-structural",
          .quantity = fmt::format("ray-disc tests per line through S0, octree of depth {}, by its nodes' areas", depth),
          .technique = std::string(name(Technique::octree)),
          .predictions = {{Form::corrected, "eq (3) summed over the octree, our derivation", expected.disc_tests}},
          .observed = ratio(batches, Counted::disc_tests, Counted::lines)};
}

Finding hits_finding(const Workload& workload, const std::vector<sim::Disc>& discs, const BatchNumbers& batches) {
  Workload one_line = workload;
  one_line.rays = 1;
  one_line.sphere_radius = sim::enclosing_sphere(discs).radius;
  return {
      .id = "hits-per-line",
      .quantity = "discs that a line through S0 hits",
      .predictions = {{Form::corrected, "eq (3) with F = 2 pi d^2, our derivation", model::expected_hits(one_line)}},
      .observed = ratio(batches, Counted::hits, Counted::lines)};
}

}  // namespace

std::vector<Finding> disc_index_findings(const Experiment& experiment) {
  std::vector<Finding> findings = cells_findings(experiment);
  const sim::Stopwatch clock;
  const Workload& workload = experiment.workload;
  const std::vector<sim::Disc> discs = sample_discs(experiment, 0);
  const int depth = tested_depth(workload);
  const std::size_t lines = share_of_rays(experiment);
  const auto batches = count_batches(experiment, discs, {Technique::octree, OctreeParameters{depth}}, 21, lines);
  if (experiment.stop.stop_requested()) return {};
  for (Finding& finding : completed({tests_finding(experiment, discs, batches, depth),
                                     structural_tests(discs, batches, depth), hits_finding(workload, discs, batches)},
                                    {.tolerance = index_tolerance, .lines = lines, .clock = clock})) {
    allow_for_rare_events(finding);
    findings.push_back(std::move(finding));
  }
  return findings;
}

double disc_index_work(const Experiment& experiment) {
  const int depth = tested_depth(experiment.workload);
  const double cells = model::published::cells_per_line(depth) *
                       static_cast<double>(lines_per_batch(experiment, lines_through_cells) * batch_count);
  const Counts<double> counts = model::octree_counts(experiment.workload, {depth});
  return cells + test_work(counts) + batch_count * build_work(counts);
}

}  // namespace detp::validate
