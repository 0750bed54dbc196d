#include "detp/model/sphere_cache/sphere_cache.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "batches.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/rank/predict.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/base/search_work.hpp"
#include "detp/validate/structural/structural_parts.hpp"
#include "experiments.hpp"

namespace detp::validate {
namespace {

constexpr double cache_tolerance = 0.025;
constexpr double compared_rebuilds = 30;

/// What is compared: geometric means over all Q and all sets.
struct CacheQuantity {
  std::string_view id;
  std::string_view what;
  std::string_view published;  ///< source of the form
  std::string_view corrected;
};
constexpr std::array quantities{
    CacheQuantity{"rebuilds", "m_i >= 30", "eq (17), at most n_P", "tabulated law, our derivation"},
    CacheQuantity{"rebuild-time", "T_R per ray, t = 1", "eq (12)", "sum over the corrected m_i and lists"},
    CacheQuantity{"intersect-time", "T_I per ray, u = 1", "eq (8)", "eq (8) with k by eq (6) and the list of S_k"}};

/// Of each quantity for one Q: counted, or predicted by one of the two forms. m_i: mean over the compared spheres.
using CacheLogs = std::array<double, quantities.size()>;

/// For each Q.
struct CacheSet {
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
double mean_log_rebuilds(const std::vector<model::SphereLevel>& levels,
                         const std::function<double(std::size_t)>& rebuilds) {
  double sum = 0;
  double count = 0;
  for (std::size_t i = 0; i < levels.size(); ++i)
    if (levels[i].rebuilds >= compared_rebuilds) {
      sum += std::log(std::max(1.0, rebuilds(i)));
      ++count;
    }
  return count > 0 ? sum / count : 0;
}

Workload enclosed_workload(const Experiment& experiment, const sim::Problem& problem) {
  Workload workload = experiment.workload;
  workload.sphere_radius = problem.enclosing().radius;
  return workload;
}

/// Adds the logarithms for one Q.
void add_ratio(CacheSet& set, double ratio, const sim::Problem& problem, const Experiment& experiment) {
  const Workload workload = enclosed_workload(experiment, problem);
  const SphereCacheParameters parameters = parameters_for(workload, ratio);
  const sim::Outcome run =
      sim::run(problem, {Technique::sphere_cache, parameters}, {.engine = Engine::plain, .stop = experiment.stop});
  if (run.stopped) return;
  const auto rays = static_cast<double>(problem.rays().size());
  const auto levels = model::sphere_levels(workload, parameters, parameters.spheres);
  const auto logs = [&](const Counts<double>& counts, double of, const std::function<double(std::size_t)>& rebuilds) {
    return CacheLogs{mean_log_rebuilds(levels, rebuilds), std::log(counts.cull_tests / of),
                     std::log(counts.disc_tests / of)};
  };
  set.counted.push_back(logs(as_expected(run.counts), rays, [&](std::size_t i) {
    // spheres in which no disc fitted were never built
    return i < run.spheres.size() ? static_cast<double>(run.spheres[i].rebuilds) : 0;
  }));
  const Counts<double> corrected = model::predict(workload, {Technique::sphere_cache, parameters});
  set.corrected.push_back(logs(corrected, workload.rays, [&](std::size_t i) { return levels[i].rebuilds; }));
  const std::int64_t k =
      model::sphere_count(Form::published, {ratio}, {workload.disc_radius}, {workload.sphere_radius});
  set.published.push_back(logs(model::published::counts(workload, {ratio}, k), workload.rays, [&](std::size_t i) {
    return std::min(workload.samples, model::published::rebuilds({ratio}, static_cast<std::int64_t>(i) + 1));
  }));
  const ExpectedWalk walk = structural_walk(problem.discs(), problem.enclosing(), parameters, experiment.stop);
  set.time_ratio.push_back(static_cast<double>(run.counts.cull_tests) / rays / walk.cull_tests);
}

std::vector<CacheSet> run_all(const Experiment& experiment, std::size_t lines) {
  return for_each_batch(experiment, [&](int number) {
    CacheSet set;
    const std::vector<sim::Disc> discs = sample_discs(experiment, number);
    const auto rays = sim::LineField(sim::enclosing_sphere(discs), batch_seed(experiment, 11, number))
                          .lines(0, lines, experiment.stop);
    const sim::Problem problem = sim::make_problem(rays, discs);
    for (const double ratio : experiment.ratios) add_ratio(set, ratio, problem, experiment);
    return set;
  });
}

/// Over all Q and all sets.
double predicted_mean(const std::vector<CacheSet>& sets, std::vector<CacheLogs> CacheSet::*form, std::size_t quantity) {
  double sum = 0;
  double count = 0;
  for (const CacheSet& set : sets)
    for (const CacheLogs& logs : set.*form) {
      sum += logs[quantity];
      ++count;
    }
  return std::exp(sum / count);
}

/// Mean logarithms over all Q of what each set counts.
BatchNumbers counted_logs(const std::vector<CacheSet>& sets) {
  BatchNumbers means;
  for (const CacheSet& set : sets) {
    std::vector<double>& mean = means.emplace_back(quantities.size());
    for (std::size_t i = 0; i < mean.size(); ++i) {
      for (const CacheLogs& logs : set.counted) mean[i] += logs[i];
      mean[i] /= static_cast<double>(set.counted.size());
    }
  }
  return means;
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
      .technique = std::string(name(Technique::sphere_cache)),
      .predictions = {{Form::published, "eq (7)", k(Form::published)}, {Form::corrected, "eq (6)", k(Form::corrected)}},
      .observed = {static_cast<double>(run.spheres.size()), 0},
      .lines = 1};
}

}  // namespace

std::vector<Finding> sphere_cache_findings(const Experiment& experiment) {
  const sim::Stopwatch clock;
  const std::size_t lines = share_of_rays(experiment);
  Finding count = count_finding(experiment);
  const std::vector<CacheSet> sets = run_all(experiment, lines);
  if (experiment.stop.stop_requested()) return {};
  const std::vector<double>& ratios = experiment.ratios;
  const std::string_view over = ratios.size() > 1 ? "geometric mean over " : "";
  const BatchNumbers counted = counted_logs(sets);
  std::vector<Finding> findings;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const auto& [id, what, published, corrected] = quantities[i];
    findings.push_back(
        {.id = std::string(id),
         .quantity = fmt::format("{}: {}Q = {}", what, over, fmt::join(ratios, ", ")),
         .predictions = {{Form::published, std::string(published), predicted_mean(sets, &CacheSet::published, i)},
                         {Form::corrected, std::string(corrected), predicted_mean(sets, &CacheSet::corrected, i)}},
         .observed = geometric_mean_of(counted, i)});
  }
  BatchNumbers time_ratios;
  for (const CacheSet& set : sets) time_ratios.push_back(set.time_ratio);
  for (std::size_t q = 0; q < ratios.size(); ++q)
    findings.push_back(
        {.id = fmt::format("rebuild-time-structural-{}", ratios[q]),
         .quantity = fmt::format("T_R counted over T_R from the sorted samples alone, Q = {}", ratios[q]),
         .predictions = {{Form::corrected, "structural walk, our derivation", 1}},
         .observed = mean_of(time_ratios, q)});
  findings = completed(std::move(findings), {name(Technique::sphere_cache), cache_tolerance, lines, clock});
  count.seconds = clock.seconds();
  findings.insert(findings.begin(), std::move(count));
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
