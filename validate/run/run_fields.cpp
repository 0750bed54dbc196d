#include "run_fields.hpp"

#include <algorithm>
#include <cmath>

#include "detp/sim/base/threads.hpp"
#include "detp/sim/ranked/ranked.hpp"
#include "detp/validate/answer/parts.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/stopping/job_batches.hpp"
#include "detp/validate/whole/accuracy_costs.hpp"

namespace detp::validate {

std::vector<double> mean_irradiance(const JobRun& run) {
  std::vector<double> means;
  for_each_disc(run, [&](std::span<const sim::DiscResult> by_band) {
    means.resize(by_band.size());
    for (std::size_t band = 0; band < by_band.size(); ++band) means[band] += by_band[band].irradiance;
  });
  for (double& mean : means) mean /= static_cast<double>(disc_count(run));
  return means;
}

Counts<std::uint64_t> counted(const RunAnswer& answer) {
  const Counts<std::uint64_t>& counts = answer.run.outcome.counts;
  return answer.request.has_technique() ? with_bytes_touched(counts, answer.candidate, answer.request.engine) : counts;
}

std::optional<sim::SumEstimate> estimated_hits(const RunAnswer& answer) {
  const sim::Outcome& outcome = answer.run.outcome;
  if (!answer.has_random_rays() || outcome.batches.rays == 0) return std::nullopt;
  return sim::estimate_sum(outcome.batches, outcome.progress.of);
}

std::vector<sim::SumEstimate> estimated_irradiance(const Job& job, const RunAnswer& answer) {
  const sim::Outcome& outcome = answer.run.outcome;
  if (!answer.has_random_rays() || outcome.irradiance_batches.rays == 0) return {};
  const double share = static_cast<double>(outcome.progress.done) / static_cast<double>(outcome.progress.of);
  std::vector<sim::SumEstimate> estimates;
  for (const double mean : mean_irradiance(answer.run)) {
    sim::SumEstimate estimate{mean / (powers_add_up(job) ? share : 1), std::nullopt};
    const sim::Batches& batches = outcome.band(estimates.size()).irradiance_batches;
    const sim::SumEstimate sum = estimate_sum(batches, outcome.progress.of);
    if (sum.standard_error && sum.value > 0) estimate.standard_error = estimate.value * *sum.standard_error / sum.value;
    estimates.push_back(estimate);
  }
  return estimates;
}

Json by_band(const Job& job, const std::vector<Json>& values) {
  if (job.bands.empty()) return values.empty() ? Json() : values.front();
  Json json = Json::object();
  for (std::size_t band = 0; band < values.size(); ++band) json[job.bands[band]] = values[band];
  return json;
}

namespace {

using Run = ShownRun;

bool stopped(const Run& run) {
  const auto& until = run.answer.until;
  return run.answer.run.outcome.stopped || (until && until->result.reason == StopReason::time);
}

/// The value of a finished run; null if it was stopped.
template <class Value>
Json if_finished(const Run& run, const Value& value) {
  return run.answer.run.outcome.stopped ? Json() : Json(value(run));
}

template <class Value>
auto of_until(Value value) {
  return of_part([](const Run& run) { return run.answer.until ? &*run.answer.until : nullptr; }, value);
}
template <class Value>
auto of_bias(Value value) {
  return of_part(
      [](const Run& run) { return run.answer.until && run.answer.until->bias ? &*run.answer.until->bias : nullptr; },
      value);
}
template <class Value>
auto of_choice(Value value) {
  return of_part([](const Run& run) { return run.answer.choice ? &*run.answer.choice : nullptr; }, value);
}
template <class Value>
auto of_pilot(Value value) {
  return of_part([](const Run& run) { return run.answer.is_piloted() ? &run.answer.choice->best() : nullptr; }, value);
}
template <class Value>
auto of_spheres(Value value) {
  return only_if(
      [](const Run& run) { return run.stops.has_value(); },
      [value](const Run& run) { return value(run, std::get<SphereCacheParameters>(run.answer.candidate.parameters)); });
}
template <class Value>
auto of_prediction(Value value) {
  return only_if([](const Run& run) { return run.predicted.has_value(); },
                 [value](const Run& run) { return value(run, *run.predicted); });
}
template <class Value>
auto of_gather(Value value) {
  return only_if([](const Run& run) { return run.answer.request.gathers(); }, value);
}
template <class Value>
auto of_stopped(Value value) {
  return only_if([](const Run& run) { return run.answer.run.outcome.stopped; }, value);
}

Json interval(double low, double high) { return {known(low), known(high)}; }

auto own_spheres_by(Form form) {
  return of_spheres([form](const Run& run, const SphereCacheParameters& cache) {
    return model::own_spheres(run.job.workload(), form, {cache.ratio});
  });
}

/// Predicted seconds, of which `total` gives those of the search.
template <class Total>
auto predicted_seconds(Total total) {
  return of_prediction([total](const Run& run, const Counts<double>& counts) {
    const RunAnswer& answer = run.answer;
    const RunRequest& request = answer.request;
    const CostBreakdown search =
        price(counts, request.costs, answer.candidate.technique, sim::useful_threads(answer.threads));
    return (total(search) + seconds_of_sums(run.job, answer, counts)) /
           static_cast<double>(std::max<std::size_t>(1, answer.run.rank_seconds.size()));
  });
}

/// T_R or T_I at unit costs of 1.
template <class Part>
auto unit_time(Part part) {
  return [part](const Run& run) {
    return price(as_expected(run.answer.run.outcome.counts), UnitCosts{}, run.answer.candidate.technique).*part;
  };
}
template <class Part>
auto predicted_unit_time(Part part) {
  return of_prediction([part](const Run& run, const Counts<double>& counts) {
    return price(counts, UnitCosts{}, run.answer.candidate.technique).*part;
  });
}

Json seconds_json(const Run& run) {
  const Timing& timing = run.answer.timing;
  Json json{{"total", timing.total()},
            {"prepare", timing.prepare},
            {"order", timing.phases.order},
            {"build", timing.phases.build},
            {"search", timing.phases.search}};
  if (run.answer.request.repeat > 0) json["all"] = timing.all;
  return json;
}

Json seconds_cells(const Run&, const Json& seconds) {
  Json cells{{"seconds", seconds["total"]}};
  for (const char* phase : {"prepare", "order", "build", "search"})
    cells[std::string(phase) + "_seconds"] = seconds[phase];
  cells["timed_runs"] = seconds.contains("all") ? seconds["all"].size() : 1;
  return cells;
}

Json rays_json(const Run& run) {
  if (run.answer.request.gathers()) return 0;
  const auto taken = taken_by(run.job, run.answer);
  return whole(taken ? taken->rays : run.job.given.rays);
}

Json photons_json(const Run& run) {
  if (run.answer.request.gathers()) return 0;
  if (run.answer.until) return run.answer.until->result.photons;
  return run.answer.taken ? whole(run.answer.taken->photons) : Json(run.job.independent_photons());
}

Json light_of(const Run& run) {
  if (const auto taken = taken_by(run.job, run.answer); taken && taken->light) return light_json(*taken->light);
  return run.job.light && !run.answer.request.gathers() ? light_json(*run.job.light) : left_out();
}

Json geometry_of(const Run& run) {
  const Job& job = run.job;
  if (job.triangles == 0) return left_out();
  Json json = geometry_json(job.polygons, job.normals_made, job.coincident);
  if (run.answer.run.outcome.stopped) return json;
  std::uint64_t unlit = 0;
  for_each_disc(run.answer.run, [&](std::span<const sim::DiscResult> disc) { unlit += disc[0].hits == 0 ? 1 : 0; });
  json["samples_unlit"] = unlit;
  return json;
}

Json ranks_json(const Run& run) {
  const auto& seconds = run.answer.run.rank_seconds;
  if (seconds.empty()) return left_out();
  return {{"count", seconds.size()},
          {"share", run.answer.run.share == sim::Share::rays ? "rays" : "discs"},
          {"seconds", seconds},
          {"imbalance", sim::imbalance(seconds)}};
}

std::vector<std::string> warnings_of(const Run& run) {
  std::vector<std::string> all = run.job.all_said();
  for (std::string& one : answer_warnings(run.job, run.answer)) all.push_back(std::move(one));
  return all;
}

/// In tables a column for each band, if there are several.
Field<Run> of_bands(const std::string& name, const std::string& unit, const std::string& meaning,
                    const std::function<Json(const Run&)>& value) {
  return Field<Run>(name, unit, meaning, value).by({name}, [name](const Run& run, const Json& values) {
    Json cells = Json::object();
    if (run.job.bands.empty()) cells[name] = values;
    for (std::size_t band = 0; band < run.job.bands.size(); ++band)
      if (values.is_object()) cells[name + "_" + run.job.bands[band]] = values[run.job.bands[band]];
    return cells;
  });
}

/// The light on parts of the surface: irradiance times area.
Json parts_json(const Job& job, const LightOnParts& light) {
  Json json = Json::array();
  for (std::size_t part = 0; part < light.parts.names.size(); ++part) {
    const double area = light.parts.areas[part];
    const auto in_bands = [&](double sim::DiscResult::*value) {
      std::vector<Json> values;
      for (std::size_t band = 0; band < light.found.bands(); ++band)
        values.push_back(known(area * (sim::result_of(light.found, part, band).*value)));
      return by_band(job, values);
    };
    json.push_back({{"name", light.parts.names[part]},
                    {"area", area},
                    {"hits", light.found.hits[part]},
                    {"light", in_bands(&sim::DiscResult::irradiance)},
                    {"standard_error", in_bands(&sim::DiscResult::standard_error)},
                    {"upper_bound", in_bands(&sim::DiscResult::upper_bound)}});
  }
  return json;
}

std::array<double, 6> numbers_of(const SeenBetween& view) {
  const auto& [from, to] = view;
  return {from.x, from.y, from.z, to.x, to.y, to.z};
}

Json faces_json(const Run& run) {
  const auto& faces = run.answer.faces;
  if (!faces) return left_out();
  return {{"materials", parts_json(run.job, faces->by_material)}, {"groups", parts_json(run.job, faces->by_group)}};
}

Json hits_estimate(const Run& run) {
  const auto all = estimated_hits(run.answer);
  return all ? Json{{"value", all->value}, {"standard_error", json_value(all->standard_error)}} : Json();
}

}  // namespace

ShownRun shown_run(const Job& job, const RunAnswer& answer, std::optional<Whole> whole_measured) {
  const Workload& workload = job.workload();
  ShownRun run{job, answer, prediction(workload, answer), predicted_whole(job, answer, workload),
               std::move(whole_measured)};
  const auto* cache = std::get_if<SphereCacheParameters>(&answer.candidate.parameters);
  if (cache == nullptr || !answer.request.has_technique()) return run;
  const Technique technique = answer.candidate.technique;
  const auto form = technique == Technique::sphere_cache ? Form::corrected : Form::published;
  run.stops = model::sphere_stops(workload, answer.request.costs[technique], form, {cache->ratio});
  return run;
}

const Fields<ShownRun>& run_fields() {
  static const Fields<Run> fields{
      {"estimator", "", "how photons become irradiance",
       [](const Run& run) { return name(run.answer.request.estimator); }},
      {"paths", "", "of gather: paths from each disc, on each side that counts",
       of_gather([](const Run& run) { return run.answer.request.paths; })},
      {"engine", "", "plain: double precision; simd: vectors of floats with exact decisions",
       [](const Run& run) { return name(run.answer.request.engine); }},
      {"threads", "", "on which it ran", [](const Run& run) { return run.answer.threads; }},
      {"technique", "", "that found the pairs, or the nearest photons; null: none",
       [](const Run& run) {
         return run.answer.request.has_technique() ? Json(name(run.answer.candidate.technique)) : Json();
       }},
      parameters_field<Run>(
          "of the technique",
          [](const Run& run) { return run.answer.request.has_technique() ? &run.answer.candidate : nullptr; }),
      {"k", "", "spheres of the sphere cache",
       of_spheres([](const Run&, const SphereCacheParameters& cache) { return cache.spheres; })},
      {"k_max", "", "spheres that can hold a disc", of_part(&Run::stops, &model::SphereStops::max)},
      {"k_best", "", "spheres with the least predicted time", of_part(&Run::stops, &model::SphereStops::best)},
      {"k_published", "", "k_max by the paper's form", own_spheres_by(Form::published)},
      {"k_corrected", "", "k_max by the corrected form", own_spheres_by(Form::corrected)},
      {"rays", "", "searched; of photon paths their pieces", rays_json},
      {"photons", "", "emitted for these rays", photons_json},
      {"hits_per_disc", "", "mean over the discs; null after a stop",
       [](const Run& run) {
         return if_finished(run, [](const Run& one) {
           return static_cast<double>(one.answer.run.outcome.total_hits) /
                  static_cast<double>(disc_count(one.answer.run));
         });
       }},
      Field<Run>("bands", "", "of powers, by name",
                 [](const Run& run) { return run.job.bands.empty() ? left_out() : Json(run.job.bands); })
          .in_json_alone(),
      of_bands(
          "mean_irradiance", "power per area",
          "mean over the discs; after a stop by all rays, as estimated from the first ones; of several bands by name",
          [](const Run& run) {
            std::vector<Json> means;
            if (run.answer.run.outcome.stopped)
              for (const sim::SumEstimate& mean : estimated_irradiance(run.job, run.answer))
                means.emplace_back(mean.value);
            else
              for (const double mean : mean_irradiance(run.answer.run)) means.emplace_back(mean);
            return by_band(run.job, means);
          }),
      of_bands("mean_irradiance_error", "power per area", "standard error of a mean that is estimated",
               of_stopped([](const Run& run) {
                 std::vector<Json> errors;
                 for (const sim::SumEstimate& mean : estimated_irradiance(run.job, run.answer))
                   errors.push_back(json_value(mean.standard_error));
                 return by_band(run.job, errors);
               })),
      {"missed_share", "", "of gather: share of the light that no backward path finds",
       of_gather([](const Run& run) { return run.answer.run.missed.share; })},
      {"missed_share_bound", "", "its upper bound, 95 %",
       of_gather([](const Run& run) { return run.answer.run.missed.upper_bound; })},
      Field<Run>("counts", "", "operations, as counted", [](const Run& run) { return to_json(counted(run.answer)); })
          .as_counts(""),
      Field<Run>("predicted", "", "operations, as predicted",
                 of_prediction([](const Run&, const Counts<double>& counts) { return to_json(counts); }))
          .as_counts("predicted_"),
      Field<Run>("predicted_error", "", "standard errors of the counts that a pilot predicted",
                 of_pilot([](const Prediction& best) { return to_json(best.counts_error); }))
          .in_json_alone(),
      {"hits", "", "pairs of a ray and a disc that it hits; null after a stop",
       [](const Run& run) {
         return if_finished(run, [](const Run& one) { return one.answer.run.outcome.total_hits; });
       }},
      {"rebuild_time", "tests", "T_R at t = 1, tests of rays against spheres or boxes",
       unit_time(&CostBreakdown::rebuild)},
      {"intersect_time", "tests", "T_I at u = 1, tests against discs", unit_time(&CostBreakdown::intersect)},
      {"predicted_rebuild_time", "tests", "the same by the formulas", predicted_unit_time(&CostBreakdown::rebuild)},
      {"predicted_intersect_time", "tests", "the same by the formulas", predicted_unit_time(&CostBreakdown::intersect)},
      {"predicted_seconds", "s", "of a first search",
       predicted_seconds([](const CostBreakdown& search) { return search.total(); })},
      {"predicted_seconds_again", "s", "of a repeated search, whose memory is there",
       predicted_seconds([](const CostBreakdown& search) { return search.again(); })},
      {"predicted_seconds_error", "s", "standard error of predicted_seconds", of_pilot(&Prediction::error)},
      {"choosing_seconds", "s", "for choosing technique and parameters", of_choice(&Choice::choosing_seconds)},
      Field<Run>("seconds", "s",
                 "from discs and rays in memory to irradiance in memory, and its phases; the median of repeated runs",
                 seconds_json)
          .by({"seconds", "prepare_seconds", "order_seconds", "build_seconds", "search_seconds", "timed_runs"},
              seconds_cells),
      {"read_seconds", "s", "for reading or making scene and discs",
       [](const Run& run) { return run.job.read_seconds; }},
      {"trace_seconds", "s", "for making rays",
       [](const Run& run) { return run.job.trace_seconds + run.answer.run.trace_seconds; }},
      {"rays_in_memory", "", "at a time, at most", [](const Run& run) { return run.answer.run.rays_in_memory; }},
      Field<Run>("whole", "s", "predicted wait of the whole command, by part",
                 [](const Run& run) { return run.whole ? whole_json(run.whole->seconds) : Json(); })
          .in({{"whole_seconds", "/total"}}),
      Field<Run>("whole_measured", "s", "the same, measured",
                 [](const Run& run) { return run.whole_measured ? whole_json(run.whole_measured->seconds) : Json(); })
          .in({{"whole_measured_seconds", "/total"}}),
      {"peak_bytes", "bytes", "predicted peak of the memory",
       [](const Run& run) { return run.whole ? run.whole->peak_bytes : std::nullopt; }},
      {"peak_bytes_measured", "bytes", "the same, measured",
       [](const Run& run) { return run.whole_measured ? run.whole_measured->peak_bytes : std::nullopt; }},
      {"stopped", "", "before the end: the answer is partial", stopped},
      {"hits_so_far", "", "of the finished rays or discs",
       of_stopped([](const Run& run) { return run.answer.run.outcome.total_hits; })},
      Field<Run>("hits_estimate", "", "of all rays, from the first ones", of_stopped(hits_estimate))
          .in({{"hits_estimate", "/value"}, {"hits_estimate_error", "/standard_error"}}),
      Field<Run>(
          "target", "", "error to reach",
          [](const Run& run) { return run.answer.until ? Json(run.answer.request.target->error.error) : left_out(); })
          .in_json_alone(),
      Field<Run>("noise_of", "", "the band whose noise and error these are; all: the sum of all bands",
                 [](const Run& run) {
                   return run.answer.until && !run.job.bands.empty()
                              ? Json(run.answer.request.target->band.value_or("all"))
                              : left_out();
                 })
          .in_json_alone(),
      {"noise", "", "of the run: root mean square over the discs by area, relative to the root mean square irradiance",
       of_until([](const UntilAnswer& until) { return until.result.noise.value; })},
      Field<Run>("noise_interval", "", "at the confidence, each end alone", of_until([](const UntilAnswer& until) {
                   return interval(until.result.noise.low, until.result.noise.high);
                 }))
          .as_interval("noise"),
      {"error", "", "noise and bias together", of_until([](const UntilAnswer& until) { return until.error().value; })},
      Field<Run>("error_interval", "", "of the error",
                 of_until([](const UntilAnswer& until) { return interval(until.error().low, until.error().high); }))
          .as_interval("error"),
      {"bias_estimate", "", "root mean square of the bias at this radius; null: not looked for",
       of_until([](const UntilAnswer& until) {
         return until.bias ? Json(std::sqrt(std::max(0.0, until.bias->squared.mean))) : Json();
       })},
      Field<Run>("bias_squared", "", "with its standard error", of_bias([](const BiasEstimate& bias) {
                   return Json{{"value", bias.squared.mean}, {"standard_error", bias.squared.standard_error}};
                 }))
          .in_json_alone(),
      Field<Run>("bias_interval", "", "of the bias, 95 %",
                 of_bias([](const BiasEstimate& bias) { return interval(bias.interval().low, bias.interval().high); }))
          .as_interval("bias"),
      {"mean_bias", "", "signed: the share of all light that the estimator gains or loses",
       of_bias([](const BiasEstimate& bias) { return bias.mean.standard_error > 0 ? Json(bias.mean.mean) : Json(); })},
      Field<Run>("bias_by", "", "what the estimator was compared with", of_bias(&BiasEstimate::by)).in_json_alone(),
      Field<Run>("bias_seconds", "s", "for finding the bias", of_bias(&BiasEstimate::seconds)).in_json_alone(),
      Field<Run>("radius_for_target", "length", "the largest radius tried whose bias is below the target",
                 of_bias([](const BiasEstimate& bias) { return bias.radius > 0 ? Json(bias.radius) : Json(); }))
          .in_json_alone(),
      {"confidence", "", "of the intervals",
       [](const Run& run) {
         return run.answer.until ? Json(run.answer.request.target->error.confidence) : left_out();
       }},
      {"stopped_because", "", "target, bias, rays or time",
       of_until([](const UntilAnswer& until) { return name(until.result.reason); })},
      {"until_seconds", "s", "with choosing, pilots, tracing and building", of_until(&UntilAnswer::seconds)},
      Field<Run>("stop_tests", "", "looks at the error",
                 of_until([](const UntilAnswer& until) { return until.result.tests + until.result.looks; }))
          .in_json_alone(),
      Field<Run>("share_bound", "", "if no photon met a disc: the share that does is smaller",
                 of_until([](const UntilAnswer& until) {
                   return until.result.share_bound ? Json(*until.result.share_bound) : left_out();
                 }))
          .in_json_alone(),
      Field<Run>("mirror_share", "", "of the area, that has no part in the error",
                 of_until([](const UntilAnswer& until) {
                   return until.mirror_share > 0 ? Json(until.mirror_share) : left_out();
                 }))
          .in_json_alone(),
      Field<Run>("faces", "", "light that lands on the surface, by material and by group", faces_json).in_json_alone(),
      Field<Run>("picture", "", "of --picture: view, from where and to where it shows the scene, as --view takes it",
                 [](const Run& run) {
                   return run.picture ? Json{{"view", numbers_of(*run.picture)}} : left_out();
                 })
          .in_json_alone(),
      effects_field<Run>([](const Run& run) { return to_json(run.job.observed().effects); }),
      Field<Run>("warnings", "", "all that was said on standard error", warnings_of).in_json_alone(),
      Field<Run>("light", "", "how photon paths ended", light_of).in_json_alone(),
      Field<Run>("geometry", "", "faces of the scene's files, and samples without a hit", geometry_of).in_json_alone(),
      Field<Run>("ranks", "", "what processes shared", ranks_json).in_json_alone()};
  return fields;
}

}  // namespace detp::validate
