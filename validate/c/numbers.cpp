#include <algorithm>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "detp/model/rank/choose.hpp"
#include "detp/model/rank/predict.hpp"
#include "detp/model/sphere_cache/sphere_cache.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"
#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/validate/choice/candidate_json.hpp"
#include "detp/validate/choice/choice.hpp"
#include "detp/validate/job/job.hpp"
#include "guard.hpp"
#include "types.hpp"

using namespace detp;

namespace {

Workload workload_of(const detp_workload* workload) {
  const detp_workload given = c::known(workload, "workload");
  validate::JobRequest request;
  request.rays = given.rays;
  request.samples = given.samples;
  request.disc_radius = validate::Length{given.disc_radius};
  request.scene_side = given.scene_side;
  request.dimension = given.dimension == 0 ? 3 : given.dimension;
  return validate::workload_of_numbers(request);
}

CostTable table_of(const detp_costs* costs) {
  return costs != nullptr ? costs->table : validate::built_in_unit_costs();
}

Technique technique_of(const std::string& text) {
  if (const auto found = technique_named(text)) return *found;
  throw std::invalid_argument("there is no technique " + detp::quoted(text));
}

/// Null: no parameters.
nlohmann::ordered_json parsed(const char* parameters) {
  if (parameters == nullptr) return nlohmann::ordered_json::object();
  auto json = nlohmann::ordered_json::parse(parameters, nullptr, false);
  if (json.is_discarded()) throw std::invalid_argument("the parameters are no JSON: " + detp::quoted(parameters));
  return json;
}

/// Writes the texts one after another, each with its 0. Returns where the last one begins.
char* write_texts(std::initializer_list<std::string> texts, char* to, std::size_t room) {
  c::given(to, "text");
  std::size_t bytes = 0;
  for (const std::string& text : texts) bytes += text.size() + 1;
  if (bytes > room) throw std::invalid_argument("text has no room for " + std::to_string(bytes) + " bytes");
  char* last = to;
  for (const std::string& text : texts) {
    last = to;
    std::memcpy(to, text.c_str(), text.size() + 1);
    to += text.size() + 1;
  }
  return last;
}

void store_time(const CostBreakdown& time, detp_prediction& to) {
  to.build_seconds = time.order + time.build;
  to.rebuild_seconds = time.rebuild;
  to.intersect_seconds = time.intersect;
  to.seconds = time.total();
}

/// Writes as many of the spheres 1 … k as there is room for.
template <class SphereAt>
void store_spheres(std::int64_t k, const SphereAt& sphere, detp_prediction& to) {
  to.k = static_cast<std::uint64_t>(k);
  if (to.spheres == nullptr) return;
  const auto count = static_cast<std::int64_t>(std::min<std::uint64_t>(to.room, to.k));
  for (std::int64_t i = 1; i <= count; ++i) to.spheres[i - 1] = sphere(i);
}

/// By the published formulas, whose only costs are those of a ray-sphere and a ray-disc test.
Candidate predict_published(const Workload& workload, const model::FixedParameters& fixed, const CostTable& costs,
                            detp_prediction& to) {
  const auto given = fixed.value<double>("ratio");
  if (!given) throw std::invalid_argument("the published formulas need a ratio");
  const RadiusRatio ratio{*given};
  const std::int64_t k = fixed.value<std::int64_t>("spheres").value_or(
      model::sphere_count(Form::published, ratio, {workload.disc_radius}, {workload.sphere_radius}));
  const UnitCosts& unit = costs[Technique::sphere_cache];
  to.counts = c::counts_of(model::published::counts(workload, ratio, k));
  store_time({.rebuild = model::published::rebuild_time(workload, ratio, k, unit.cull_test),
              .intersect = model::published::intersect_time(workload, ratio, k, unit.disc_test)},
             to);
  to.threads = 1;
  store_spheres(
      k,
      [&](std::int64_t i) {
        const double rays = model::published::rays_in_sphere(workload.rays, ratio, i);
        return detp_sphere{.radius = workload.sphere_radius * std::pow(ratio.value, static_cast<double>(i)),
                           .rays = rays,
                           .listed = rays,
                           .rebuilds = model::published::rebuilds(ratio, i),
                           .rebuild_cost = model::published::rebuild_cost(workload.rays, ratio, i, 1)};
      },
      to);
  return {Technique::sphere_cache, SphereCacheParameters{ratio.value, k}};
}

Candidate predict_corrected(Technique technique, const Workload& workload, const model::FixedParameters& fixed,
                            const CostTable& costs, int threads, detp_prediction& to) {
  const auto candidate = model::complete(technique, fixed, workload, costs);
  if (!candidate) throw std::length_error(std::string(name(technique)) + " would not fit in memory on this workload");
  const Prediction found = model::assess(workload, *candidate, costs, sim::useful_threads(threads));
  to.counts = c::counts_of(found.counts);
  store_time(found.time, to);
  to.threads = found.threads;
  if (technique != Technique::sphere_cache) return *candidate;
  const auto& parameters = std::get<SphereCacheParameters>(candidate->parameters);
  std::vector<model::SphereLevel> levels;
  if (to.spheres != nullptr && parameters.spheres > 0)
    levels = model::sphere_levels(workload, parameters,
                                  static_cast<std::int64_t>(std::min<std::uint64_t>(to.room, INT64_MAX)));
  store_spheres(
      parameters.spheres,
      [&](std::int64_t i) {
        const model::SphereLevel& level = levels[static_cast<std::size_t>(i - 1)];
        return detp_sphere{.radius = level.radius,
                           .rays = level.rays,
                           .listed = level.listed,
                           .rebuilds = level.rebuilds,
                           .rebuild_cost = level.tests};
      },
      to);
  return *candidate;
}

}  // namespace

extern "C" {

detp_status detp_choose(const detp_workload* workload, const detp_costs* costs, int threads, char* text, size_t room,
                        detp_plan_facts* facts, detp_error* error) {
  return c::guarded(error, [&] {
    detp_plan_facts ours = c::known(facts, "facts");
    const validate::Choice choice = validate::choose(
        {.workload = workload_of(workload), .rigor = Rigor::estimate, .threads = threads}, table_of(costs));
    const Prediction& best = choice.best();
    ours.parameters =
        write_texts({std::string(name(best.candidate.technique)), to_json(best.candidate).dump()}, text, room);
    ours.technique = text;
    ours.discs = 0;
    ours.threads = best.threads;
    ours.predicted_seconds = best.time.total();
    ours.predicted_seconds_again = best.time.again();
    ours.prepare_seconds = best.time.order + best.time.build;
    ours.peak_bytes =
        sizeof(sim::Ray) * workload->rays + sizeof(sim::Disc) * workload->samples + best.counts.bytes_touched;
    ours.predicted_error = 0;
    ours.planning_seconds = choice.choosing_seconds;
    c::write_back(facts, ours);
  });
}

detp_status detp_predict(const detp_workload* workload, const char* technique, const char* parameters, int published,
                         const detp_costs* costs, int threads, char* text, size_t room, detp_prediction* prediction,
                         detp_error* error) {
  return c::guarded(error, [&] {
    detp_prediction ours = c::known(prediction, "prediction");
    ours.k = 0;
    const Technique chosen = technique_of(&c::given(technique, "technique"));
    const model::FixedParameters fixed = fixed_parameters_of(chosen, parsed(parameters));
    const Workload of_numbers = workload_of(workload);
    if (published != 0 && chosen != Technique::sphere_cache)
      throw std::invalid_argument("published formulas are those of sphere-cache; `detp_ask` has those of the octree");
    const Candidate candidate = published != 0
                                    ? predict_published(of_numbers, fixed, table_of(costs), ours)
                                    : predict_corrected(chosen, of_numbers, fixed, table_of(costs), threads, ours);
    write_texts({to_json(candidate).dump()}, text, room);
    c::write_back(prediction, ours);
  });
}
}
