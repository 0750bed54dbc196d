#include "detp/model/sphere_cache/sphere_cache.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "batches.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/rank/predict.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/base/search_work.hpp"
#include "detp/validate/structural/structural_parts.hpp"
#include "experiments.hpp"

namespace detp::validate {
namespace {

constexpr double cache_tolerance = 0.025;
constexpr double least_rebuilds = 30;

/// Logarithms of m_i, and of T_R and T_I per ray, for one Q: counted, or predicted by one of the two forms.
struct CacheLogs {
  double rebuilds = 0;  ///< mean over the compared spheres
  double rebuild_time = 0;
  double intersect_time = 0;
};

/// For each Q.
struct CacheSet {
  explicit CacheSet(std::size_t ratios = 0)
      : counted(ratios), published(ratios), corrected(ratios), time_ratio(ratios) {}

  std::vector<CacheLogs> counted, published, corrected;
  std::vector<double> time_ratio;  ///< counted T_R divided by the structural T_R
};

SphereCacheParameters parameters_for(const Workload& workload, double ratio) {
  const std::int64_t k =
      model::sphere_count(Form::corrected, {ratio}, {workload.disc_radius}, {workload.sphere_radius});
  return {ratio, std::max<std::int64_t>(1, k), SampleOrder::lebesgue};
}

/// Mean of ln m_i over the spheres for which the corrected law predicts at least 30 rebuilds: the same spheres for
/// counts and predictions.
template <class Rebuilds>
double mean_log_rebuilds(const std::vector<model::SphereLevel>& levels, const Rebuilds& rebuilds) {
  double sum = 0;
  double count = 0;
  for (std::size_t i = 0; i < levels.size(); ++i)
    if (levels[i].rebuilds >= least_rebuilds) {
      sum += std::log(std::max(1.0, rebuilds(i)));
      ++count;
    }
  return count > 0 ? sum / count : 0;
}

void compare(CacheSet& result, std::size_t q, const Workload& workload, const sim::Problem& problem,
             const Experiment& experiment) {
  const double ratio = experiment.ratios[q];
  const SphereCacheParameters parameters = parameters_for(workload, ratio);
  const sim::Outcome run =
      sim::run(problem, {Technique::sphere_cache, parameters}, {.engine = Engine::plain, .stop = experiment.stop});
  if (run.stopped) return;
  const auto rays = static_cast<double>(problem.rays().size());
  const auto levels = model::sphere_levels(workload, parameters, parameters.spheres);
  const auto of_published = [&](std::size_t i) {
    return std::min(workload.samples, model::published::rebuilds({ratio}, static_cast<std::int64_t>(i) + 1));
  };
  result.counted[q] = {mean_log_rebuilds(levels,
                                         [&](std::size_t i) {  // spheres in which no disc fitted were never built
                                           return i < run.spheres.size() ? static_cast<double>(run.spheres[i].rebuilds)
                                                                         : 0;
                                         }),
                       std::log(static_cast<double>(run.counts.cull_tests) / rays),
                       std::log(static_cast<double>(run.counts.disc_tests) / rays)};
  const Counts<double> corrected = model::predict(workload, {Technique::sphere_cache, parameters});
  result.corrected[q] = {mean_log_rebuilds(levels, [&](std::size_t i) { return levels[i].rebuilds; }),
                         std::log(corrected.cull_tests / workload.rays),
                         std::log(corrected.disc_tests / workload.rays)};
  const std::int64_t k =
      model::sphere_count(Form::published, {ratio}, {workload.disc_radius}, {workload.sphere_radius});
  const Counts<double> published = model::published::counts(workload, {ratio}, k);
  result.published[q] = {mean_log_rebuilds(levels, of_published), std::log(published.cull_tests / workload.rays),
                         std::log(published.disc_tests / workload.rays)};
  const ExpectedWalk walk = structural_walk(problem.discs(), problem.enclosing(), parameters, experiment.stop);
  result.time_ratio[q] = static_cast<double>(run.counts.cull_tests) / rays / walk.cull_tests;
}

Workload enclosed_workload(const Experiment& experiment, const sim::Problem& problem) {
  Workload workload = experiment.workload;
  workload.sphere_radius = problem.enclosing().radius;
  return workload;
}

std::vector<CacheSet> run_all(const Experiment& experiment, std::size_t lines) {
  return for_each_batch(experiment, [&](int set) {
    CacheSet result(experiment.ratios.size());
    const std::vector<sim::Disc> discs = sample_discs(experiment, set);
    const auto rays =
        sim::LineField(sim::enclosing_sphere(discs), batch_seed(experiment, 11, set)).lines(0, lines, experiment.stop);
    const sim::Problem problem = sim::make_problem(rays, discs);
    for (std::size_t q = 0; q < experiment.ratios.size(); ++q)
      compare(result, q, enclosed_workload(experiment, problem), problem, experiment);
    return result;
  });
}

using LogsOfSet = std::vector<CacheLogs> CacheSet::*;

/// Over all Q and all sets.
double geometric_mean(const std::vector<CacheSet>& sets, LogsOfSet columns, double CacheLogs::*term) {
  double sum = 0;
  double count = 0;
  for (const CacheSet& set : sets)
    for (const CacheLogs& logs : set.*columns) {
      sum += logs.*term;
      ++count;
    }
  return std::exp(sum / count);
}

/// Geometric mean of the counts over all Q and all sets. The standard error is that of the mean logarithm between sets,
/// multiplied by the mean.
Estimate counted(const std::vector<CacheSet>& sets, double CacheLogs::*term) {
  std::vector<double> logs;
  for (const CacheSet& set : sets) {
    double sum = 0;
    for (const CacheLogs& one : set.counted) sum += one.*term;
    logs.push_back(sum / static_cast<double>(set.counted.size()));
  }
  const Estimate log = batch_means(logs);
  return {std::exp(log.mean), std::exp(log.mean) * log.standard_error};
}

/// Compares k with the number of nested spheres of a run that stops only when no disc fits in the next sphere.
Finding count_finding(const Experiment& experiment) {
  const bool usual = std::ranges::find(experiment.ratios, model::published_ratio) != experiment.ratios.end();
  const double ratio = usual ? model::published_ratio : experiment.ratios.front();
  const std::vector<sim::Disc> discs = sample_discs(experiment, 0);
  const auto ray = sim::LineField(sim::enclosing_sphere(discs), experiment.seed).lines(0, 1);
  const sim::Problem problem = sim::make_problem(ray, discs);
  const Workload workload = enclosed_workload(experiment, problem);
  const sim::Outcome run =
      sim::run(problem, {Technique::sphere_cache, SphereCacheParameters{ratio, 10'000}}, {.engine = Engine::plain});
  const auto k = [&](Form form) {
    return static_cast<double>(model::sphere_count(form, {ratio}, {workload.disc_radius}, {workload.sphere_radius}));
  };
  return {
      .id = "sphere-count",
      .quantity = fmt::format("k at Q = {}: spheres that can hold a disc", ratio),
      .predictions = {{Form::published, "eq (7)", k(Form::published)}, {Form::corrected, "eq (6)", k(Form::corrected)}},
      .observed = {static_cast<double>(run.spheres.size()), 0},
      .lines = 1};
}

Finding mean_finding(const std::vector<CacheSet>& sets, double CacheLogs::*term, Finding finding,
                     std::string_view published, std::string_view corrected) {
  finding.predictions = {{Form::published, std::string(published), geometric_mean(sets, &CacheSet::published, term)},
                         {Form::corrected, std::string(corrected), geometric_mean(sets, &CacheSet::corrected, term)}};
  finding.observed = counted(sets, term);
  finding.batches = batch_count;
  finding.tolerance = cache_tolerance;
  return finding;
}

Finding walk_finding(const std::vector<CacheSet>& sets, std::size_t q, double ratio) {
  std::vector<double> values;
  for (const CacheSet& set : sets) values.push_back(set.time_ratio[q]);
  return {.id = fmt::format("rebuild-time-structural-{}", ratio),
          .quantity = fmt::format("T_R counted over T_R from the sorted samples alone, Q = {}", ratio),
          .predictions = {{Form::corrected, "structural walk, our derivation", 1}},
          .observed = batch_means(values),
          .batches = batch_count,
          .tolerance = cache_tolerance};
}

}  // namespace

std::vector<Finding> sphere_cache_findings(const Experiment& experiment) {
  const sim::Stopwatch clock;
  const std::size_t lines =
      std::max<std::size_t>(100, static_cast<std::size_t>(experiment.workload.rays) / batch_count);
  std::vector<Finding> findings{count_finding(experiment)};
  const std::vector<CacheSet> sets = run_all(experiment, lines);
  if (experiment.stop.stop_requested()) return {};
  const std::vector<double>& ratios = experiment.ratios;
  const std::string at =
      fmt::format("{}Q = {}", ratios.size() > 1 ? "geometric mean over " : "", fmt::join(ratios, ", "));
  const auto mean = [&](std::string_view what) { return fmt::format("{}: {}", what, at); };
  findings.push_back(mean_finding(sets, &CacheLogs::rebuilds, {.id = "rebuilds", .quantity = mean("m_i >= 30")},
                                  "eq (17), at most n_P", "tabulated law, our derivation"));
  findings.push_back(mean_finding(sets, &CacheLogs::rebuild_time,
                                  {.id = "rebuild-time", .quantity = mean("T_R per ray, t = 1")}, "eq (12)",
                                  "sum over the corrected m_i and lists"));
  findings.push_back(mean_finding(sets, &CacheLogs::intersect_time,
                                  {.id = "intersect-time", .quantity = mean("T_I per ray, u = 1")}, "eq (8)",
                                  "eq (8) with k by eq (6) and the list of S_k"));
  for (std::size_t q = 0; q < ratios.size(); ++q) findings.push_back(walk_finding(sets, q, ratios[q]));
  for (Finding& finding : findings) {
    finding.technique = name(Technique::sphere_cache);
    finding.lines = std::max<std::uint64_t>(finding.lines, finding.batches > 0 ? lines * batch_count : 1);
    finding.seconds = clock.seconds();
  }
  return findings;
}

double sphere_cache_work(const Experiment& experiment) {
  double work = 0;
  for (const double ratio : experiment.ratios) {
    const SphereCacheParameters parameters = parameters_for(experiment.workload, ratio);
    const auto counts = model::predict(experiment.workload, {Technique::sphere_cache, parameters}, Engine::plain);
    // The structural walk uses 64 lines for the first 500 rebuilds of each level, 8 for all later ones. A line takes 10
    // units of work.
    const double lines =
        8 * counts.culls + 56 * std::min(counts.culls, 500.0 * static_cast<double>(parameters.spheres));
    work += test_work(counts, Engine::plain) + batch_count * (build_work(counts) + 10 * lines);
  }
  return work;
}

}  // namespace detp::validate
