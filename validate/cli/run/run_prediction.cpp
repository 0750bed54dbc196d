#include "run_report.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "detp/model/disc_index/disc_index_published.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/model/rank/predict.hpp"
#include "detp/model/rank/registry.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/validate/whole/accuracy_costs.hpp"

namespace detp::cli {
namespace {

const sim::Stopwatch since_start;  // since the program was loaded

/// By the paper's formulas, at the number of spheres or the depth of the run.
Counts<double> published_counts(const Workload& workload, const Candidate& candidate) {
  if (const auto* cache = std::get_if<SphereCacheParameters>(&candidate.parameters))
    return model::published::counts(workload, {cache->ratio}, cache->spheres);
  const int depth = std::get<OctreeParameters>(candidate.parameters).depth;
  return {.disc_tests = workload.rays * model::published::tests_per_line(workload.samples, depth),
          .nodes = workload.rays * model::published::cells_per_line(depth)};
}

}  // namespace

bool is_predicted(const RunAnswer& answer) {
  return answer.estimator == sim::Estimator::disc && answer.choice && answer.choice->sampled_rays > 0;
}

bool is_published(Technique technique) {
  return technique == Technique::sphere_cache || technique == Technique::sphere_cache_published ||
         technique == Technique::octree;
}

std::optional<Counts<double>> prediction(const Workload& workload, const RunAnswer& answer) {
  if (answer.form == Form::published) return published_counts(workload, answer.candidate);
  return best_prediction(workload, answer);
}

std::optional<Counts<double>> best_prediction(const Workload& workload, const RunAnswer& answer) {
  if (answer.until) return {};
  if (is_predicted(answer)) return answer.choice->best().counts;
  if (answer.estimator != sim::Estimator::disc || !model::has_closed_form(answer.candidate.technique)) return {};
  try {
    return model::predict(workload, answer.candidate, answer.engine);
  } catch (const std::invalid_argument&) {  // no closed form for these parameters: another order, tree or traversal
    return {};
  }
}

namespace {

/// Of an estimator that looks at photons; those of its pairs are not counted before, but expected.
Whole whole_of_estimator(const validate::Job& job, const RunAnswer& answer) {
  const Workload& workload = job.given;
  const double rays = std::max(1.0, workload.rays);
  const double edge = job.surface.edge_length;
  const auto* map = std::get_if<PhotonMapParameters>(&answer.candidate.parameters);
  const validate::AccuracyCosts costs(job.triangles, answer.threads);
  const validate::SettingCounts counts{
      .hits_per_ray = model::expected_hits(workload) / rays,
      .radius_over_edge = edge > 0 ? workload.disc_radius / edge : 0,
      .nearest_per_ray = map != nullptr ? static_cast<double>(map->nearest) / rays : 0};
  constexpr double searched_again = 115;  // bytes a ray of variable-radius: AMD EPYC (Zen 5), four scenes
  const double beside = answer.estimator == sim::Estimator::variable_radius ? searched_again * rays : 0;
  Whole whole{validate::whole_seconds(answer.whole, {}, 0, answer.threads), validate::peak_bytes(answer.whole, beside)};
  whole.seconds.search =
      (1 + answer.repeat) * costs.estimate(answer.estimator, workload.samples, counts).at(workload.rays);
  return whole;
}

}  // namespace

std::optional<Whole> predicted_whole(const validate::Job& job, const RunAnswer& answer, const Workload& workload) {
  const bool by_photons = answer.estimator != sim::Estimator::disc && !gathers(answer);
  if (by_photons && !answer.until) return whole_of_estimator(job, answer);
  const auto counts = best_prediction(workload, answer);
  if (!counts) return std::nullopt;
  const int threads = sim::useful_threads(answer.threads);
  const CostBreakdown search = price(*counts, answer.costs, answer.candidate.technique, threads);
  const double pilot = answer.choice ? static_cast<double>(answer.choice->sampled_rays) : 0;
  Whole whole{validate::whole_seconds(answer.whole, search, pilot, answer.threads),
              validate::peak_bytes(answer.whole, counts->bytes_touched)};
  whole.seconds.search *= 1 + answer.repeat;
  return whole;
}

Whole measured_whole(const validate::Job& job, const RunAnswer& answer) {
  const sim::Phases& phases = answer.run.outcome.seconds;
  validate::WholeSeconds seconds{
      .read = job.read_seconds,
      .trace = job.trace_seconds + answer.run.trace_seconds,
      .prepare = phases.order + phases.build + (answer.choice ? answer.choice->choosing_seconds : 0),
      .search = answer.run.prepare_seconds + phases.search};
  if (answer.repeat > 0) seconds.search += std::accumulate(answer.timing.all.begin(), answer.timing.all.end(), 0.0);
  if (answer.until) seconds.search = std::max(0.0, answer.until->seconds - seconds.trace);
  seconds.rest = std::max(0.0, since_start.seconds() - seconds.total());
  return {seconds, validate::measured_peak_bytes()};
}

}  // namespace detp::cli
