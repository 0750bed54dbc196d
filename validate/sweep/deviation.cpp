#include "sweep.hpp"

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

/// Of one candidate on all sets.
struct Observed {
  std::vector<Counts<double>> counts;
  std::vector<std::vector<sim::SphereCounts>> spheres;
};

/// The comparisons of one candidate.
struct DeviationRows {
  Deviation common;  ///< point and candidate
  std::vector<Deviation> rows = {};

  void add(std::string_view quantity, std::int64_t sphere, Form form, double predicted, const Estimate& observed) {
    if (!(observed.mean > 0)) return;
    Deviation& row = rows.emplace_back(common);
    row.quantity = quantity;
    row.sphere = sphere;
    row.form = form;
    row.predicted = predicted;
    row.observed = observed;
  }
};

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
  for (const CountTerm<double>& term : count_terms<double>) {
    const double value = predicted.*term.term;
    if (value == 0 || term.name == "loaded" || term.name == "segments" || term.name == "sorted") continue;
    std::vector<double> sets;
    for (const Counts<double>& counts : counted) sets.push_back(counts.*term.term);
    Estimate observed = batch_means(sets);
    if (depends_on_lines(term.name))
      observed = allow_for_few(observed, observed.mean * static_cast<double>(counted.size()));
    rows.add(term.name, 0, form, value, observed);
  }
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
  DeviationRows rows{{.dimension = point.dimension,
                      .samples = point.samples,
                      .disc_share = point.disc_share,
                      .technique = std::string(name(candidate.technique)),
                      .parameters = describe(candidate)}};
  if (const auto published = published_counts(workload, candidate))
    compare_counts(rows, Form::published, *published, observed.counts);
  compare_counts(rows, Form::corrected, model::predict(workload, candidate, Engine::plain), observed.counts);
  if (const auto* cache = std::get_if<SphereCacheParameters>(&candidate.parameters))
    compare_spheres(rows, workload, *cache, observed);
  return std::move(rows.rows);
}

}  // namespace

std::vector<Deviation> measure_point(const SweepPoint& point, std::uint64_t seed, const std::stop_token& stop) try {
  const std::vector<Candidate> candidates = sweep_candidates(point);
  std::vector<Observed> observed(candidates.size());
  Workload workload = point.workload();
  workload.sphere_radius = 0;  // the mean over the sets
  for (int set = 0; set < point.sets; ++set) {
    const std::vector<sim::Disc> discs = point.discs(seed, set, stop);
    const sim::LineField field(sim::enclosing_sphere(discs), seed * 7919 + static_cast<std::uint64_t>(set));
    const auto lines = field.lines(0, point.lines, stop);
    const sim::Problem problem = sim::make_problem(lines, discs);
    workload.sphere_radius += problem.enclosing().radius / point.sets;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const sim::Outcome outcome = sim::run(problem, candidates[i], {.engine = Engine::plain, .stop = stop});
      if (outcome.stopped) return {};
      observed[i].counts.push_back(as_expected(outcome.counts));
      observed[i].spheres.push_back(outcome.spheres);
    }
  }
  std::vector<Deviation> rows;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    for (Deviation& row : compare(point, workload, candidates[i], observed[i])) rows.push_back(std::move(row));
  return rows;
} catch (const sim::Stopped&) {
  return {};
}

}  // namespace detp::validate
