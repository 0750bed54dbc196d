// Measures the default unit costs of validate/choice/unit_costs.cpp. Times the techniques with a closed form, except
// sphere-tree, on uniform samples and isotropic lines, for several disc radii, numbers of samples and rays, and
// parameters, on one thread, in processor time. Prints the unit costs fitted to the runs, and the median and 95th
// percentile of the error of the computed times. With an argument (`list`), also lists the runs.
//
//   cmake --build build --target unit_costs_table && build/unit_costs_table

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "detp/model/hierarchy/box_tree.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/scene/open/uniform_discs.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/choice/unit_costs.hpp"
#include "detp/validate/statistics/statistics.hpp"

namespace {

using namespace detp;

std::vector<Candidate> candidates(double radius, double outer, double pairs) {
  std::vector<Candidate> list;
  if (pairs < 2e8) list.push_back({Technique::brute_force, BruteForceParameters{}});
  for (const double ratio : {0.4, 0.65, 0.8})
    list.push_back(
        {Technique::sphere_cache,
         SphereCacheParameters{
             ratio, std::max<std::int64_t>(1, model::sphere_count(Form::corrected, {ratio}, {radius}, {outer}) - 1)}});
  for (const int depth : {4, 5}) list.push_back({Technique::cell_spheres, CellSpheresParameters{depth}});
  list.push_back({Technique::box_tree, BoxTreeParameters{4, 16}});
  for (const int depth : {4, 5, 6, 7}) list.push_back({Technique::octree, OctreeParameters{depth}});
  for (const int cells : {16, 40, 100}) list.push_back({Technique::grid, GridParameters{cells}});
  return list;
}

constexpr double longest = 0.1;  ///< seconds: runs that take longer are left out

/// The phases of a run in processor time, which other processes do not affect. The processor time of the whole run is
/// divided among the phases in proportion to their wall-clock times.
sim::Phases run_alone(const sim::Problem& problem, const Candidate& candidate) {
  const sim::ProcessorStopwatch watch;
  sim::Phases phases = sim::run(problem, candidate, {.count = false}).seconds;
  const double share = watch.seconds() / phases.total();
  for (double* const phase : {&phases.order, &phases.build, &phases.search}) *phase *= share;
  return phases;
}

validate::TimedRun time(const sim::Problem& problem, const Candidate& candidate) {
  validate::TimedRun best{.technique = candidate.technique};
  const sim::Outcome counted = sim::run(problem, candidate);
  best.counts = as_expected(counted.counts);
  if (counted.seconds.total() > longest) return best;
  for (int repeat = 0; repeat < 3; ++repeat) {
    sim::Phases phases = run_alone(problem, candidate);
    if (repeat > 0 && phases.total() >= best.order + best.build + best.search) continue;
    best.order = phases.order;
    best.build = phases.build;
    best.search = phases.search;
  }
  return best;
}

double total(const validate::TimedRun& run) { return run.order + run.build + run.search; }

}  // namespace

int main(int arguments, char**) {
  std::vector<validate::TimedRun> runs;
  for (const auto body : {sim::Body::cube, sim::Body::cube_faces})
    for (const double radius : {0.005, 0.02, 0.08})
      for (const std::size_t samples : {5'000UL, 40'000UL})
        for (const std::size_t rays : {3'000UL, 30'000UL}) {
          const auto discs = sim::uniform_discs(body, 2, samples, radius, 1);
          const auto lines = sim::LineField(sim::enclosing_sphere(discs), 2).lines(0, rays);
          const sim::Problem problem = sim::make_problem(lines, discs);
          for (const Candidate& candidate :
               candidates(radius, problem.enclosing().radius, static_cast<double>(samples * rays)))
            if (const auto run = time(problem, candidate); run.search > 0) runs.push_back(run);
        }
  const UnitCosts costs = validate::fit_unit_costs(runs);
  for (const UnitCostTerm& term : unit_cost_terms)
    fmt::print("{} {:.2g}  {}\n", term.symbol, costs.*term.cost, term.meaning);
  std::vector<double> errors;
  if (arguments > 1)
    for (const auto& run : runs)
      fmt::print("{:12} order {:.2e} build {:.2e} search {:.2e} predicted {:.2e} | {} {} {} {} {} {} {} {}\n",
                 name(run.technique), run.order, run.build, run.search, price(run.counts, costs, run.technique).total(),
                 run.counts.cull_tests, run.counts.disc_tests, run.counts.listed, run.counts.culls, run.counts.steps,
                 run.counts.nodes, run.counts.sorted, run.counts.placements);
  for (const auto& run : runs)
    errors.push_back(std::abs(std::log(price(run.counts, costs, run.technique).total() / total(run))));
  fmt::print("{} runs; predicted/measured off by {:.2f}x in the median, {:.2f}x at the 95th percentile\n", runs.size(),
             std::exp(validate::median(errors)), std::exp(validate::quantile(errors, 0.95)));
}
