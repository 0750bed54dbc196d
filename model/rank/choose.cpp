#include "choose.hpp"

#include <algorithm>

#include "detp/model/disc_index/disc_index_published.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"
#include "predict.hpp"

namespace detp::model {
namespace {

bool is_number(const Parameter& parameter) { return parameter.choices.empty(); }

bool are_all_numbers_fixed(const FixedParameters& fixed, Technique technique) {
  const auto& parameters = record_of(technique).parameters;
  return std::all_of(parameters.begin(), parameters.end(), [&](const Parameter& parameter) {
    return !is_number(parameter) || std::any_of(fixed.values.begin(), fixed.values.end(),
                                                [&](const auto& value) { return value.first == parameter.name; });
  });
}

/// The technique with the parameters in `fixed` and the best other ones.
struct Completed {
  Candidate candidate;
  std::optional<Counts<double>> counts = {};  ///< as in FoundParameters, if no parameter is fixed
  bool tuned = true;
};

std::optional<Completed> completed(Technique technique, const FixedParameters& fixed, const Valid<Workload>& workload,
                                   const Valid<CostTable>& costs, const SearchLimits& limits) {
  Candidate candidate = candidate_with(technique, fixed);
  if (!is_open(technique, fixed)) return Completed{candidate};
  SearchLimits of_engine = limits;
  of_engine.engine = costs.engine;
  const auto best = model_of(technique).best(workload, costs_of(costs, technique), fixed, of_engine);
  if (!best) return std::nullopt;
  candidate.parameters = best->parameters;
  for (const auto& [name, value] : fixed.values) set_parameter(candidate, name, value);
  return Completed{candidate, fixed.values.empty() ? best->counts : std::nullopt, best->tuned};
}

Prediction ranked(const Valid<Workload>& workload, const Valid<Candidate>& candidate, const Counts<double>& found,
                  const Valid<CostTable>& costs, int most_threads) {
  require_count("number of threads", most_threads, 1, 1e6);
  const Counts<double> counts = with_bytes_touched(found, candidate, costs.engine);
  const auto fastest = fastest_price(counts, costs, candidate.technique, most_threads);
  return {.candidate = candidate,
          .counts = counts,
          .time = fastest.time,
          .threads = fastest.threads,
          .extrapolated = extrapolations(workload, candidate)};
}

bool is_faster(const Prediction& a, const Prediction& b) {
  return a.time.total() != b.time.total() ? a.time.total() < b.time.total()
                                          : a.candidate.technique < b.candidate.technique;
}

}  // namespace

Candidate candidate_with(Technique technique, const FixedParameters& fixed) {
  Candidate candidate = default_candidate(technique);
  for (const auto& [name, value] : fixed.values) set_parameter(candidate, name, value);
  return candidate;
}

bool is_open(Technique technique, const FixedParameters& fixed) {
  return model_of(technique).best != nullptr && !are_all_numbers_fixed(fixed, technique);
}

Prediction assess(const Valid<Workload>& workload, const Valid<Candidate>& candidate, const Valid<CostTable>& costs,
                  int most_threads) {
  return ranked(workload, candidate, predict(workload, candidate, costs.engine), costs, most_threads);
}

std::optional<Candidate> complete(Technique technique, const FixedParameters& fixed, const Valid<Workload>& workload,
                                  const Valid<CostTable>& costs, const SearchLimits& limits) {
  const auto found = completed(technique, fixed, workload, costs, limits);
  return found ? std::optional(found->candidate) : std::nullopt;
}

std::optional<Prediction> best_of(Technique technique, const Valid<Workload>& workload, const Valid<CostTable>& costs,
                                  const SearchLimits& limits) {
  if (!has_closed_form(technique)) return std::nullopt;
  const auto found = completed(technique, {}, workload, costs, limits);
  if (!found) return std::nullopt;
  const auto* cache = std::get_if<SphereCacheParameters>(&found->candidate.parameters);
  if (cache != nullptr && cache->spheres == 0) return std::nullopt;  // this is brute force
  const Valid<Candidate> candidate(found->candidate);
  Prediction best =
      ranked(workload, candidate, found->counts ? *found->counts : predict(workload, candidate, costs.engine), costs,
             limits.threads);
  best.tuned = found->tuned;
  return best;
}

std::vector<Prediction> rank(const Valid<Workload>& workload, const Valid<CostTable>& costs,
                             const SearchLimits& limits) {
  std::vector<Prediction> ranking;
  SearchLimits so_far = limits;
  const auto add = [&](Technique technique) {
    auto best = best_of(technique, workload, costs, so_far);
    if (!best) return;
    so_far.fastest = std::min(so_far.fastest, price(best->counts, costs, technique).total());  // on one thread
    ranking.push_back(std::move(*best));
  };
  // Brute force needs no search. The box tree is mostly the fastest, so that the others need little search.
  for (const Technique technique : {Technique::brute_force, Technique::box_tree})
    if (ranking.empty() || !limits.stop.stop_requested()) add(technique);
  for (const Technique technique : exact_techniques) {
    if (limits.stop.stop_requested()) break;
    if (technique != Technique::brute_force && technique != Technique::box_tree) add(technique);
  }
  std::sort(ranking.begin(), ranking.end(), is_faster);
  return ranking;
}

Candidate paper_rule(const Valid<Workload>& workload, const ProcessorCache& cache) {
  require_positive("size of the processor's cache", cache.bytes);
  require_positive("bytes of a ray", cache.bytes_per_ray);
  const DiscRadius d{workload.disc_radius};
  const std::int64_t k =
      std::max<std::int64_t>(1, sphere_count(Form::corrected, {published_ratio}, d, {workload.sphere_radius}));
  const Candidate spheres{Technique::sphere_cache, SphereCacheParameters{published_ratio, k, SampleOrder::lebesgue}};
  const Candidate index{Technique::octree,
                        OctreeParameters{std::min(20, published::octree_depth(d, scene_side(workload)))}};
  const double x = sample_distance(workload) / workload.disc_radius;
  if (x <= 2) return index;
  if (x >= 6) return spheres;
  const double inner_bytes = published::rays_in_sphere(workload.rays, {published_ratio}, k) * cache.bytes_per_ray;
  return inner_bytes <= cache.bytes ? spheres : index;
}

}  // namespace detp::model
