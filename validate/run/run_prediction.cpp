#include "run.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "detp/model/disc_index/disc_index_published.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/model/rank/predict.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/model/techniques/registry.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/validate/whole/accuracy_costs.hpp"

namespace detp::validate {
namespace {

/// By the paper's formulas, at the number of spheres or the depth of the run.
Counts<double> published_counts(const Workload& workload, const Candidate& candidate) {
  if (const auto* cache = std::get_if<SphereCacheParameters>(&candidate.parameters))
    return model::published::counts(workload, {cache->ratio}, cache->spheres);
  const int depth = std::get<OctreeParameters>(candidate.parameters).depth;
  return {.disc_tests = workload.rays * model::published::tests_per_line(workload.samples, depth),
          .nodes = workload.rays * model::published::cells_per_line(depth)};
}

/// Whatever form is requested.
std::optional<Counts<double>> best_prediction(const Workload& workload, const RunAnswer& answer) {
  if (answer.until) return {};
  if (answer.is_piloted()) return answer.choice->best().counts;
  if (answer.request.estimator != sim::Estimator::disc || !model::has_closed_form(answer.candidate.technique))
    return {};
  try {
    return model::predict(workload, answer.candidate, answer.request.engine);
  } catch (const std::invalid_argument&) {  // no closed form for these parameters: another order, tree or traversal
    return {};
  }
}

}  // namespace

std::optional<Counts<double>> prediction(const Workload& workload, const RunAnswer& answer) {
  if (answer.request.form == Form::published) return published_counts(workload, answer.candidate);
  return best_prediction(workload, answer);
}

namespace {

/// Of an estimator that looks at photons; those of its pairs are not counted before, but expected.
Whole whole_of_estimator(const Job& job, const RunAnswer& answer) {
  const Workload& workload = job.given;
  const double rays = std::max(1.0, workload.rays);
  const double edge = job.surface.edge_length;
  const auto* map = std::get_if<PhotonMapParameters>(&answer.candidate.parameters);
  const AccuracyCosts costs(job.triangles, answer.threads);
  const SettingCounts counts{.hits_per_ray = model::expected_hits(workload) / rays,
                             .radius_over_edge = edge > 0 ? workload.disc_radius / edge : 0,
                             .nearest_per_ray = map != nullptr ? static_cast<double>(map->nearest) / rays : 0};
  constexpr double searched_again = 115;  // bytes a ray of variable-radius: AMD EPYC (Zen 5), four scenes
  const double beside = answer.request.estimator == sim::Estimator::variable_radius ? searched_again * rays : 0;
  Whole whole{whole_seconds(answer.whole, {}, 0, answer.threads), peak_bytes(answer.whole, beside)};
  whole.seconds.search = (1 + answer.request.repeat) *
                         costs.estimate(answer.request.estimator, workload.samples, counts).at(workload.rays);
  return whole;
}

}  // namespace

double seconds_of_sums(const Job& job, const RunAnswer& answer, const Counts<double>& counts) {
  const auto blocks = sim::PhotonBlocks::for_discs(job.disc_count());
  return sums_seconds({.rays = job.given.rays,
                       .hits = counts.hits,
                       .discs = static_cast<double>(job.disc_count()),
                       .blocks = 1 + static_cast<double>(blocks.of(job.independent_photons())),
                       .bands = static_cast<double>(std::max<std::size_t>(1, job.bands.size())),
                       .errors = answer.request.standard_error,
                       .numbered = job.numbered()},
                      answer.request.costs);
}

std::optional<Whole> predicted_whole(const Job& job, const RunAnswer& answer, const Workload& workload) {
  const bool by_photons = answer.request.estimator != sim::Estimator::disc && !answer.request.gathers();
  if (by_photons && !answer.until) return whole_of_estimator(job, answer);
  const auto counts = best_prediction(workload, answer);
  if (!counts) return std::nullopt;
  const int threads = sim::useful_threads(answer.threads);
  const CostBreakdown search = price(*counts, answer.request.costs, answer.candidate.technique, threads);
  const double pilot = answer.choice ? static_cast<double>(answer.choice->sampled_rays) : 0;
  Whole whole{whole_seconds(answer.whole, search, pilot, answer.threads),
              peak_bytes(answer.whole, counts->bytes_touched)};
  whole.seconds.search += seconds_of_sums(job, answer, *counts);
  whole.seconds.search *= 1 + answer.request.repeat;
  return whole;
}

Whole measured_whole(const Job& job, const RunAnswer& answer, double seconds_so_far) {
  const sim::Phases& phases = answer.run.outcome.seconds;
  WholeSeconds seconds{.read = job.read_seconds,
                       .trace = job.trace_seconds + answer.run.trace_seconds,
                       .prepare = phases.order + phases.build + (answer.choice ? answer.choice->choosing_seconds : 0),
                       .search = answer.run.prepare_seconds + phases.search};
  if (answer.request.repeat > 0)
    seconds.search += std::accumulate(answer.timing.all.begin(), answer.timing.all.end(), 0.0);
  if (answer.until) seconds.search = std::max(0.0, answer.until->seconds - seconds.trace);
  seconds.rest = std::max(0.0, seconds_so_far - seconds.total());
  return {seconds, measured_peak_bytes()};
}

}  // namespace detp::validate
