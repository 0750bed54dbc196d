#include "deviation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "detp/model/disc_index/disc_index_published.hpp"
#include "detp/model/rank/predict.hpp"
#include "detp/model/sphere_cache/sphere_cache.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"

namespace detp::validate {
namespace {

constexpr double least_rebuilds = 30;

struct Observed {
  std::vector<Counts<double>> counts;
  std::vector<std::vector<sim::SphereCounts>> spheres;
};

struct Observations {
  std::vector<Observed> of_candidates;
  double sphere_radius = 0;  ///< radius of S₀, mean over the sets
};

class DeviationRows {
 public:
  DeviationRows(const SweepPoint& point, const Candidate& candidate) {
    row_.dimension = point.dimension;
    row_.samples = point.samples;
    row_.disc_share = point.disc_share;
    row_.technique = name(candidate.technique);
    row_.parameters = describe(candidate);
  }

  void add(std::string_view quantity, std::int64_t sphere, Form form, double predicted, const Estimate& observed) {
    if (!(observed.mean > 0)) return;
    row_.quantity = quantity;
    row_.sphere = sphere;
    row_.form = form;
    row_.predicted = predicted;
    row_.observed = observed;
    rows_.push_back(row_);
  }

  [[nodiscard]] std::vector<Deviation> deviations() && { return std::move(rows_); }

 private:
  Deviation row_;
  std::vector<Deviation> rows_;
};

std::vector<double> column(const std::vector<Counts<double>>& sets, std::string_view wanted) {
  std::vector<double> values;
  for (const Counts<double>& counts : sets)
    for_each_term(counts, [&](std::string_view term, double value) {
      if (term == wanted) values.push_back(value);
    });
  return values;
}

/// Raises the standard error to that of `events` independent events if it is less, since a few sets may agree by
/// chance.
Estimate allow_for_few(Estimate estimate, double events) {
  if (events > 0) estimate.standard_error = std::max(estimate.standard_error, estimate.mean / std::sqrt(events));
  return estimate;
}

bool depends_on_lines(std::string_view term) {
  return term != "culls" && term != "visits" && term != "references" && term != "placements" && term != "made";
}

void compare_counts(DeviationRows& rows, Form form, const Counts<double>& predicted,
                    const std::vector<Counts<double>>& counted) {
  for_each_term(predicted, [&](std::string_view term, double value) {
    if (value == 0 || term == "loaded" || term == "segments" || term == "sorted") return;
    Estimate observed = batch_means(column(counted, term));
    if (depends_on_lines(term)) observed = allow_for_few(observed, observed.mean * static_cast<double>(counted.size()));
    rows.add(term, 0, form, value, observed);
  });
}

/// The counts by the paper's formulas; nothing if the paper has none for the technique.
std::optional<Counts<double>> published_counts(const Workload& workload, const Candidate& candidate) {
  if (const auto* cache = std::get_if<SphereCacheParameters>(&candidate.parameters)) {
    const std::int64_t k =
        model::sphere_count(Form::published, {cache->ratio}, {workload.disc_radius}, {workload.sphere_radius});
    return model::published::counts(workload, {cache->ratio}, k);
  }
  if (const auto* octree = std::get_if<OctreeParameters>(&candidate.parameters)) {
    const double side = scene_side(workload) + 2 * workload.disc_radius;
    const double radius = workload.sphere_radius;
    // share of the lines that hit the cube
    const double cube = 1.5 / std::numbers::pi * side * side / (radius * radius);
    return Counts<double>{.disc_tests =
                              workload.rays * cube * model::published::tests_per_line(workload.samples, octree->depth)};
  }
  return std::nullopt;
}

void compare_spheres(DeviationRows& rows, const Workload& workload, const SphereCacheParameters& parameters,
                     const Observed& observed) {
  std::size_t built = observed.spheres.front().size();
  for (const auto& spheres : observed.spheres) built = std::min(built, spheres.size());
  const auto levels = model::sphere_levels(workload, parameters, static_cast<std::int64_t>(built));
  for (std::size_t i = 0; i < levels.size(); ++i) {
    std::vector<double> rebuilds;
    std::vector<double> listed;
    for (const auto& spheres : observed.spheres) {
      rebuilds.push_back(static_cast<double>(spheres[i].rebuilds));
      listed.push_back(static_cast<double>(spheres[i].listed));
    }
    const Estimate m = batch_means(rebuilds);
    if (m.mean < least_rebuilds) continue;
    const std::int64_t index = levels[i].i;
    rows.add("m_i", index, Form::corrected, levels[i].rebuilds, m);
    rows.add("m_i", index, Form::published,
             std::min(workload.samples, model::published::rebuilds({parameters.ratio}, index)), m);
    const double events = std::accumulate(listed.begin(), listed.end(), 0.0);
    rows.add("L_i", index, Form::corrected, levels[i].listed, allow_for_few(batch_ratio(listed, rebuilds), events));
  }
}

std::vector<Deviation> compare(const SweepPoint& point, const Workload& workload, const Candidate& candidate,
                               const Observed& observed) {
  DeviationRows rows(point, candidate);
  if (const auto published = published_counts(workload, candidate))
    compare_counts(rows, Form::published, *published, observed.counts);
  compare_counts(rows, Form::corrected, model::predict(workload, candidate, Engine::plain), observed.counts);
  if (const auto* cache = std::get_if<SphereCacheParameters>(&candidate.parameters))
    compare_spheres(rows, workload, *cache, observed);
  return std::move(rows).deviations();
}

/// Returns false if a stop was requested.
bool observe_set(const SweepPoint& point, const std::vector<Candidate>& candidates, std::uint64_t seed, int set,
                 const std::stop_token& stop, Observations& all) {
  const std::vector<sim::Disc> discs = point.discs(seed, set, stop);
  const sim::LineField field(sim::enclosing_sphere(discs), seed * 7919 + static_cast<std::uint64_t>(set));
  const auto lines = field.lines(0, point.lines, stop);
  const sim::Problem problem = sim::make_problem(lines, discs);
  all.sphere_radius += problem.enclosing().radius / point.sets;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const sim::Outcome outcome = sim::run(problem, candidates[i], {.engine = Engine::plain, .stop = stop});
    if (outcome.stopped) return false;
    all.of_candidates[i].counts.push_back(as_expected(outcome.counts));
    all.of_candidates[i].spheres.push_back(outcome.spheres);
  }
  return true;
}

bool same_quantity(const DeviationSummary& summary, const Deviation& deviation) {
  return summary.technique == deviation.technique && summary.quantity == deviation.quantity &&
         summary.form == deviation.form;
}

void fill(DeviationSummary& summary, std::span<const Deviation> deviations) {
  std::vector<double> sizes;
  for (const Deviation& deviation : deviations) {
    if (!same_quantity(summary, deviation)) continue;
    if (!(deviation.relative_error() <= summary.goal.worst / 4)) {
      ++summary.noisy;
      continue;
    }
    const double size = std::abs(deviation.relative());
    if (size > summary.goal.worst + 3 * deviation.relative_error()) ++summary.beyond;
    if (sizes.empty() || size > summary.worst) {
      summary.worst = size;
      summary.worst_at = deviation;
    }
    sizes.push_back(size);
  }
  summary.compared = sizes.size();
  if (sizes.empty()) return;
  summary.median = median(sizes);
  summary.p95 = quantile(sizes, 0.95);
}

}  // namespace

Goal goal_of(const Deviation& deviation) {
  if (deviation.quantity == "L_i") return {0.02, 0.02};
  if (deviation.technique == "sphere-cache") return {0.10, 0.04};
  if (deviation.technique == "box-tree")
    return deviation.quantity == "culls" || deviation.quantity == "visits" ? Goal{0.15, 0.05} : Goal{0.12, 0.05};
  return {0.03, 0.03};
}

std::vector<DeviationSummary> summarise(std::span<const Deviation> deviations) {
  std::vector<DeviationSummary> summaries;
  for (const Deviation& deviation : deviations) {
    const auto known = std::find_if(summaries.begin(), summaries.end(),
                                    [&](const DeviationSummary& summary) { return same_quantity(summary, deviation); });
    if (known != summaries.end()) continue;
    summaries.push_back({.technique = deviation.technique,
                         .quantity = deviation.quantity,
                         .form = deviation.form,
                         .goal = goal_of(deviation),
                         .worst_at = {}});
    fill(summaries.back(), deviations);
  }
  return summaries;
}

std::vector<Deviation> measure_point(const SweepPoint& point, std::uint64_t seed, const std::stop_token& stop) try {
  const std::vector<Candidate> candidates = sweep_candidates(point);
  Observations all{.of_candidates = std::vector<Observed>(candidates.size())};
  for (int set = 0; set < point.sets; ++set)
    if (!observe_set(point, candidates, seed, set, stop, all)) return {};
  Workload workload = point.workload();
  workload.sphere_radius = all.sphere_radius;
  std::vector<Deviation> rows;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    for (Deviation& row : compare(point, workload, candidates[i], all.of_candidates[i])) rows.push_back(std::move(row));
  return rows;
} catch (const sim::Stopped&) {
  return {};
}

}  // namespace detp::validate
