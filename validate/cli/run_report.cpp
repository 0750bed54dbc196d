#include "run_report.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "detp/model/predict.hpp"
#include "detp/validate/unit_costs.hpp"
#include "sphere_stops.hpp"
#include "workload_options.hpp"

namespace detp::cli {
namespace {

Json seconds_json(const Timing& timing, int repeat) {
  Json json{{"total", timing.total()},
            {"prepare", timing.prepare},
            {"order", timing.phases.order},
            {"build", timing.phases.build},
            {"search", timing.phases.search}};
  if (repeat > 0) json["all"] = timing.all;
  return json;
}

double mean_irradiance(const sim::Outcome& outcome) {
  double sum = 0;
  for (const double irradiance : outcome.irradiance) sum += irradiance;
  return sum / static_cast<double>(outcome.irradiance.size());
}

double hits_per_disc(const sim::Outcome& outcome) {
  return static_cast<double>(outcome.total_hits) / static_cast<double>(outcome.hits.size());
}

/// Nothing where there is no closed form of the candidate.
std::optional<Counts<double>> prediction(const Workload& workload, const Candidate& candidate) {
  if (!has_closed_form(candidate.technique)) return {};
  try {
    return model::predict(workload, candidate);
  } catch (const std::invalid_argument&) {  // of these parameters: another order, tree or traversal
    return {};
  }
}

void add_stops(const Workload& workload, const Candidate& candidate, Json& json) {
  const auto* cache = std::get_if<SphereCacheParameters>(&candidate.parameters);
  if (cache == nullptr) return;
  const auto form = candidate.technique == Technique::sphere_cache ? model::Form::corrected : model::Form::published;
  const SphereStops stops = sphere_stops(workload, validate::built_in_unit_costs(), form, {cache->ratio});
  json["k"] = cache->spheres;
  json["k_max"] = stops.max;
  json["k_best"] = stops.best;
}

Json answer_json(const validate::Job& job, const RunAnswer& answer) {
  const sim::Outcome& outcome = answer.run.outcome;
  Json json{{"technique", name(answer.candidate.technique)}, {"parameters", to_json(answer.candidate.parameters)}};
  add_stops(job.workload, answer.candidate, json);
  json.update({{"hits", outcome.total_hits},
               {"hits_per_disc", hits_per_disc(outcome)},
               {"mean_irradiance", mean_irradiance(outcome)},
               {"counts", to_json(outcome.counts)}});
  if (const auto predicted = prediction(job.workload, answer.candidate)) {
    json["predicted"] = to_json(*predicted);
    json["predicted_seconds"] = price(*predicted, validate::built_in_unit_costs(), answer.candidate.technique).total();
  }
  json.update({{"seconds", seconds_json(answer.timing, answer.repeat)},
               {"read_seconds", job.read_seconds + answer.run.read_seconds},
               {"rays_in_memory", answer.run.rays_in_memory},
               {"warnings", job.warnings},
               {"stopped", outcome.stopped}});
  return json;
}

Json cells_of(const Json& inputs, const Candidate& candidate, const Json& json) {
  Json cells = workload_cells(inputs);
  cells["engine"] = inputs["engine"];
  cells["threads"] = inputs["threads"];
  cells.update(candidate_cells(candidate));
  for (const auto& [name, value] : json.items())
    if (!value.is_structured()) cells[name] = value;
  cells.update(count_cells(json["counts"]));
  if (json.contains("predicted")) {
    const Json predicted = count_cells(json["predicted"]);
    for (const auto& [name, value] : predicted.items()) cells["predicted_" + name] = value;
  }
  const Json& seconds = json["seconds"];
  cells["seconds"] = seconds["total"];
  for (const char* phase : {"prepare", "order", "build", "search"})
    cells[std::string(phase) + "_seconds"] = seconds[phase];
  cells["timed_runs"] = seconds.contains("all") ? seconds["all"].size() : 1;
  return cells;
}

}  // namespace

AnswerRow run_row(Json inputs, const validate::Job& job, const RunAnswer& answer) {
  Json json = answer_json(job, answer);
  Json cells = cells_of(inputs, answer.candidate, json);
  return {std::move(inputs), std::move(json), {std::move(cells)}};
}

Columns run_columns() {
  return workload_columns() + Columns{"engine", "threads"} + candidate_columns() +
         Columns{"k", "k_max", "k_best", "hits_per_disc", "mean_irradiance"} + count_columns() +
         count_columns("predicted_") +
         Columns{"predicted_seconds", "seconds",    "prepare_seconds", "order_seconds",  "build_seconds",
                 "search_seconds",    "timed_runs", "read_seconds",    "rays_in_memory", "stopped"};
}

TextColumns run_text_columns() {
  return {{"scene", "field", "ray_file", "front_facing", "rays", "samples", "disc_radius", "engine", "technique",
           "parameters"},
          {"hits", "sphere_tests", "predicted_sphere_tests", "disc_tests", "predicted_disc_tests", "seconds",
           "predicted_seconds"}};
}

std::string to_text(const validate::Job& job, const RunAnswer& answer) {
  const sim::Outcome& outcome = answer.run.outcome;
  const Timing& timing = answer.timing;
  std::string text = describe(job);
  text += fmt::format("technique {} {}\n", name(answer.candidate.technique), describe(answer.candidate.parameters));
  text += fmt::format("hits      {}, {:.4g} a disc; mean irradiance {:.6g}\n", outcome.total_hits,
                      hits_per_disc(outcome), mean_irradiance(outcome));
  text += fmt::format(
      "seconds   {:.4g}: prepare {:.3g}, order {:.3g}, build {:.3g}, search {:.3g}; reading {:.3g} before\n",
      timing.total(), timing.prepare, timing.phases.order, timing.phases.build, timing.phases.search,
      job.read_seconds + answer.run.read_seconds);
  text += "counts    ";
  std::string counts;
  for_each_term(outcome.counts, [&](std::string_view term, std::uint64_t value) {
    if (value > 0) counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", term, value);
  });
  text += counts + "\n";
  if (outcome.stopped) text += "stopped   before the end: what is above is partial\n";
  return text;
}

std::string per_disc_csv(const sim::Outcome& outcome) {
  std::string csv = "disc,hits,irradiance\n";
  for (std::size_t disc = 0; disc < outcome.hits.size(); ++disc)
    csv += fmt::format("{},{},{}\n", disc, outcome.hits[disc], outcome.irradiance[disc]);
  return csv;
}

}  // namespace detp::cli
