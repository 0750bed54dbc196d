#include "run_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "detp/sim/base/threads.hpp"
#include "detp/sim/photons/light_notes.hpp"
#include "detp/sim/technique/ranked.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/cli/options/candidate_options.hpp"
#include "detp/validate/cli/report/answer_rows.hpp"
#include "detp/validate/cli/report/effects_report.hpp"
#include "detp/validate/cli/report/prediction_report.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/table.hpp"
#include "detp/validate/stopping/job_batches.hpp"
#include "run_until.hpp"

namespace detp::cli {
namespace {

/// Whether a technique found the pairs, or the nearest photons.
bool has_technique(const RunAnswer& answer) {
  return sim::record_of(answer.estimator).finds_pairs || answer.estimator == sim::Estimator::nearest;
}

Json seconds_json(const Timing& timing, int repeat) {
  Json json{{"total", timing.total()},
            {"prepare", timing.prepare},
            {"order", timing.phases.order},
            {"build", timing.phases.build},
            {"search", timing.phases.search}};
  if (repeat > 0) json["all"] = timing.all;
  return json;
}

double mean_irradiance(const RunAnswer& answer) {
  double sum = 0;
  for_each_disc(answer.run, [&](const sim::DiscResult& result) { sum += result.irradiance; });
  return sum / static_cast<double>(disc_count(answer.run));
}

double hits_per_disc(const RunAnswer& answer) {
  return static_cast<double>(answer.run.outcome.total_hits) / static_cast<double>(disc_count(answer.run));
}

/// The counts, with the memory that belongs to them.
Counts<std::uint64_t> counted(const RunAnswer& answer) {
  const Counts<std::uint64_t>& counts = answer.run.outcome.counts;
  return has_technique(answer) ? with_bytes_touched(counts, answer.candidate, answer.engine) : counts;
}

void add_stops(const Workload& workload, const Candidate& candidate, const CostTable& costs, Json& json) {
  const auto* cache = std::get_if<SphereCacheParameters>(&candidate.parameters);
  if (cache == nullptr) return;
  const auto form = candidate.technique == Technique::sphere_cache ? Form::corrected : Form::published;
  const model::SphereStops stops = model::sphere_stops(workload, costs[candidate.technique], form, {cache->ratio});
  json["k"] = cache->spheres;
  json["k_max"] = stops.max;
  json["k_best"] = stops.best;
  json["k_published"] = model::own_spheres(workload, Form::published, {cache->ratio});
  json["k_corrected"] = model::own_spheres(workload, Form::corrected, {cache->ratio});
}

/// T_R and T_I at unit costs of 1, under the names that `model` gives them.
Json unit_times(const Counts<double>& counts, Technique technique, const std::string& prefix = "") {
  const CostBreakdown times = price(counts, UnitCosts{}, technique);
  return {{prefix + "rebuild_time", times.rebuild}, {prefix + "intersect_time", times.intersect}};
}

/// The estimated hits of all rays; nothing if no ray is finished, or if the finished rays do not represent all rays.
std::optional<sim::SumEstimate> estimate(const RunAnswer& answer) {
  const sim::Outcome& outcome = answer.run.outcome;
  if (!answer.random_rays || outcome.batches.rays == 0) return std::nullopt;
  return sim::estimate_sum(outcome.batches, outcome.progress.of);
}

/// What the first rays say of the mean irradiance by all; nothing if they do not represent all rays.
std::optional<sim::SumEstimate> irradiance_estimate(const validate::Job& job, const RunAnswer& answer) {
  const sim::Outcome& outcome = answer.run.outcome;
  if (!answer.random_rays || outcome.irradiance_batches.rays == 0) return std::nullopt;
  const double share = static_cast<double>(outcome.progress.done) / static_cast<double>(outcome.progress.of);
  sim::SumEstimate estimate{mean_irradiance(answer) / (validate::powers_add_up(job) ? share : 1), std::nullopt};
  const sim::SumEstimate sum = estimate_sum(outcome.irradiance_batches, outcome.progress.of);
  if (sum.standard_error && sum.value > 0) estimate.standard_error = estimate.value * *sum.standard_error / sum.value;
  return estimate;
}

std::string with_error(const std::optional<double>& standard_error) {
  return standard_error ? fmt::format(" ± {:.2g}", *standard_error) : " (error not known)";
}

Json hits_so_far(const validate::Job& job, const RunAnswer& answer) {
  Json json{{"hits", nullptr},
            {"hits_per_disc", nullptr},
            {"mean_irradiance", nullptr},
            {"mean_irradiance_error", nullptr},
            {"hits_so_far", answer.run.outcome.total_hits},
            {"hits_estimate", nullptr}};
  if (const auto all = estimate(answer)) {
    json["hits_estimate"] = {{"value", all->value}, {"standard_error", nullptr}};
    if (all->standard_error) json["hits_estimate"]["standard_error"] = *all->standard_error;
  }
  if (const auto mean = irradiance_estimate(job, answer)) {
    json["mean_irradiance"] = mean->value;
    if (mean->standard_error) json["mean_irradiance_error"] = *mean->standard_error;
  }
  return json;
}

std::string hits_text(const validate::Job& job, const RunAnswer& answer) {
  const sim::Outcome& outcome = answer.run.outcome;
  if (!outcome.stopped)
    return fmt::format("{}, {:.4g} a disc; mean irradiance {:.6g}", outcome.total_hits, hits_per_disc(answer),
                       mean_irradiance(answer));
  std::string text =
      fmt::format("{} of the {} {} done", outcome.total_hits, outcome.progress.done, outcome.progress.unit);
  if (const auto all = estimate(answer)) {
    text += fmt::format("; of all rays an estimated {:.5g}", all->value);
    text += with_error(all->standard_error);
  }
  if (const auto mean = irradiance_estimate(job, answer))
    text +=
        fmt::format("; mean irradiance by all an estimated {:.6g}{}", mean->value, with_error(mean->standard_error));
  return text;
}

/// Nothing if a run took the job's rays.
std::optional<RaysTaken> taken_by(const validate::Job& job, const RunAnswer& answer) {
  if (!answer.until) return answer.taken;
  const validate::UntilResult& result = answer.until->result;
  return RaysTaken{static_cast<double>(result.rays), result.photons,
                   job.light ? std::optional(answer.until->light) : std::nullopt};
}

std::uint64_t discs_without_hits(const JobRun& run) {
  std::uint64_t count = 0;
  for_each_disc(run, [&](const sim::DiscResult& disc) { count += disc.hits == 0 ? 1 : 0; });
  return count;
}

/// What a run without hits met, and the likely reason.
std::string why_nothing(const validate::Job& job, const RunAnswer& answer) {
  if (gathers(answer)) return fmt::format("no light: no path of {} discs finds a light", job.disc_count());
  std::string text =
      fmt::format("no hits: none of {} rays meets one of {} discs", answer.run.outcome.progress.of, job.disc_count());
  if (!job.light) return text + ": do the discs lie where the rays are, and are they large enough?";
  if (job.light->landings == 0) return text + ": no photon meets a surface";
  return text +
         fmt::format(
             ", although photons land {:.3g} times each: do discs lie where the light is? A disc whose normal is "
             "between those of the faces around, as at a corner that is smooth (--crease), lies beside them; "
             "--samples N adds samples on faces, and --estimator triangle-hits needs none",
             static_cast<double>(job.light->landings) / static_cast<double>(job.light->all_photons()));
}

std::vector<std::string> warnings_of(const validate::Job& job, const RunAnswer& answer) {
  std::vector<std::string> all = job.all_said();
  for (std::string& one : answer_warnings(job, answer)) all.push_back(std::move(one));
  return all;
}

Json answer_json(const validate::Job& job, const RunAnswer& answer) {
  const sim::Outcome& outcome = answer.run.outcome;
  Json json{{"estimator", name(answer.estimator)},
            {"technique", nullptr},
            {"parameters", Json::object()},
            {"engine", name(answer.engine)},
            {"threads", answer.threads}};
  if (has_technique(answer)) {
    json["technique"] = name(answer.candidate.technique);
    json["parameters"] = to_json(answer.candidate);
    add_stops(job.workload(), answer.candidate, answer.costs, json);
  }
  json.update(outcome.stopped ? hits_so_far(job, answer)
                              : Json{{"hits", outcome.total_hits},
                                     {"hits_per_disc", hits_per_disc(answer)},
                                     {"mean_irradiance", mean_irradiance(answer)}});
  json["rays"] = gathers(answer) ? whole(0) : whole(answer.taken ? answer.taken->rays : job.given.rays);
  json["photons"] = gathers(answer) ? Json(0)
                    : answer.taken  ? whole(answer.taken->photons)
                                    : Json(job.independent_photons());
  if (gathers(answer))
    json.update({{"paths", answer.paths},
                 {"missed_share", answer.run.missed.share},
                 {"missed_share_bound", answer.run.missed.upper_bound}});
  if (answer.until) json.update(to_json(*answer.until));
  json["counts"] = to_json(counted(answer));
  json.update(unit_times(as_expected(outcome.counts), answer.candidate.technique));
  if (answer.choice) json["choosing_seconds"] = answer.choice->choosing_seconds;
  if (is_predicted(answer)) {
    json["predicted_error"] = to_json(answer.choice->best().counts_error);
    json["predicted_seconds_error"] = answer.choice->best().error;
  }
  const auto predicted = prediction(job.workload(), answer);
  if (predicted) {
    json["predicted"] = to_json(*predicted);
    json.update(unit_times(*predicted, answer.candidate.technique, "predicted_"));
    const CostBreakdown search =
        price(*predicted, answer.costs, answer.candidate.technique, sim::useful_threads(answer.threads));
    const double errors =
        answer.standard_error ? validate::standard_error_seconds(predicted->hits, job.numbered(), answer.costs) : 0;
    const auto ranks = static_cast<double>(std::max<std::size_t>(1, answer.run.rank_seconds.size()));
    json["predicted_seconds"] = (search.total() + errors) / ranks;
    json["predicted_seconds_again"] = (search.again() + errors) / ranks;
  }
  const auto whole = predicted_whole(job, answer, job.workload());
  json["whole"] = whole ? whole_json(whole->seconds) : Json();
  json["peak_bytes"] = whole ? Json(*whole->peak_bytes) : Json();
  json.update({{"seconds", seconds_json(answer.timing, answer.repeat)},
               {"read_seconds", job.read_seconds},
               {"trace_seconds", job.trace_seconds + answer.run.trace_seconds},
               {"rays_in_memory", answer.run.rays_in_memory},
               {"effects", to_json(job.observed().effects)},
               {"warnings", warnings_of(job, answer)},
               {"stopped", outcome.stopped}});
  json.update(ledgers_json(job));
  if (gathers(answer)) json.erase("light");
  if (const auto taken = taken_by(job, answer); taken && taken->light) json["light"] = light_json(*taken->light);
  if (json.contains("geometry") && !outcome.stopped) json["geometry"]["samples_unlit"] = discs_without_hits(answer.run);
  if (const auto& seconds = answer.run.rank_seconds; !seconds.empty())
    json["ranks"] = {{"count", seconds.size()},
                     {"share", answer.run.share == sim::Share::rays ? "rays" : "discs"},
                     {"seconds", seconds},
                     {"imbalance", sim::imbalance(seconds)}};
  if (answer.until && answer.until->result.reason == validate::StopReason::time) json["stopped"] = true;
  return json;
}

Json run_cells(const Json& inputs, const RunAnswer& answer, const Json& json) {
  Json cells = workload_cells(inputs);
  if (has_technique(answer)) cells.update(candidate_cells(answer.candidate));
  for (const auto& [name, value] : json.items())
    if (!value.is_structured()) cells[name] = value;
  cells.update(effect_cells(json["effects"]));
  cells.update(count_cells(json["counts"]));
  cells["hits"] = json["hits"];
  for (const std::string what : {"noise", "bias", "error"}) {
    if (!json.contains(what + "_interval")) continue;
    cells[what + "_low"] = json[what + "_interval"][0];
    cells[what + "_high"] = json[what + "_interval"][1];
  }
  for (const char* alone :
       {"target", "stop_tests", "share_bound", "mirror_share", "bias_by", "bias_seconds", "radius_for_target"})
    cells.erase(alone);
  if (json.contains("hits_estimate") && !json["hits_estimate"].is_null()) {
    cells["hits_estimate"] = json["hits_estimate"]["value"];
    cells["hits_estimate_error"] = json["hits_estimate"]["standard_error"];
  }
  if (json.contains("predicted")) {
    const Json predicted = count_cells(json["predicted"]);
    for (const auto& [name, value] : predicted.items()) cells["predicted_" + name] = value;
  }
  for (const std::string which : {"whole", "whole_measured"}) {
    cells[which + "_seconds"] = json[which].is_null() ? Json() : json[which]["total"];
    cells.erase(which);
  }
  const Json& seconds = json["seconds"];
  cells["seconds"] = seconds["total"];
  for (const char* phase : {"prepare", "order", "build", "search"})
    cells[std::string(phase) + "_seconds"] = seconds[phase];
  cells["timed_runs"] = seconds.contains("all") ? seconds["all"].size() : 1;
  return cells;
}

/// Empty if there were fewer than two timed runs.
std::string repeats_text(const Timing& timing) {
  if (timing.all.size() < 2) return "";
  const auto [least, most] = std::minmax_element(timing.all.begin(), timing.all.end());
  return fmt::format("; median of {} runs, ± {:.1g} (half their range)", timing.all.size(), 0.5 * (*most - *least));
}

std::string over(double predicted, double counted) {
  return fmt::format("{:.4g} counted, {:.4g} predicted ({:.2f})", counted, predicted, predicted / counted);
}

/// "formulas  T_R …; T_I …", for who asked for a form; empty without a prediction.
std::string formulas_text(const validate::Job& job, const RunAnswer& answer) {
  const auto predicted = prediction(job.workload(), answer);
  if (!predicted || answer.run.outcome.stopped) return "";
  const CostBreakdown expected = price(*predicted, UnitCosts{}, answer.candidate.technique);
  const CostBreakdown found = price(as_expected(answer.run.outcome.counts), UnitCosts{}, answer.candidate.technique);
  std::string text = fmt::format("formulas  {}, in tests: ", name(answer.form.value()));
  if (found.rebuild > 0) text += fmt::format("T_R {}; ", over(expected.rebuild, found.rebuild));
  if (found.traverse > 0) text += fmt::format("nodes {}; ", over(expected.traverse, found.traverse));
  if (found.intersect > 0) text += fmt::format("T_I {}", over(expected.intersect, found.intersect));
  const auto* cache = std::get_if<SphereCacheParameters>(&answer.candidate.parameters);
  if (cache == nullptr) return text;
  const std::int64_t own = model::own_spheres(job.workload(), *answer.form, {cache->ratio});
  text += fmt::format("; k = {}", cache->spheres);
  if (cache->spheres != own)
    text += fmt::format("; by this form {} spheres can hold a disc, which detp model takes: --spheres {}", own, own);
  return text;
}

std::string_view meaning(std::string_view term) {
  static const std::map<std::string_view, std::string_view> meanings{
      {"loaded", "rays brought into the search"},
      {"segments", "of these, rays in a search in which some rays end"},
      {"cull_tests", "tests of a ray in a list against a sphere or box: rebuild_time, T_R at t = 1"},
      {"culls", "lists made, one for each sphere or box"},
      {"listed", "rays put into these lists"},
      {"visits", "discs tested with a list"},
      {"disc_tests", "tests of a ray against a disc: intersect_time, T_I at u = 1"},
      {"doubtful", "of these, decided again in double precision"},
      {"steps", "cells visited by a ray"},
      {"nodes", "nodes of a tree visited"},
      {"references", "disc references stored in the index"},
      {"placements", "discs put into cells or nodes while building"},
      {"made", "nodes of a tree of boxes or spheres made"},
      {"sorted", "discs sorted along a curve"},
      {"hits", "pairs of a ray and a disc that it hits"},
      {"bytes_touched", "memory of a first search, by the sizes of its arrays"}};
  return meanings.at(term);
}

std::string counts_table(const validate::Job& job, const RunAnswer& answer, const Screen& screen) {
  const auto predicted = prediction(job.workload(), answer);
  const Counts<std::uint64_t> counts = counted(answer);
  TextTable table({{.head = "count", .align = Align::left},
                   {.head = "counted"},
                   {.head = "predicted"},
                   {.head = "predicted / counted", .spare = 2},
                   {.head = "meaning", .align = Align::left, .spare = 1}});
  for (const auto& [term, count] : count_terms<std::uint64_t>) {
    const auto found = static_cast<double>(counts.*count);
    if (found == 0) continue;
    double expected = 0;
    if (predicted && !answer.run.outcome.stopped)
      for (const auto& [other, value] : count_terms<double>)
        if (other == term) expected = (*predicted).*value;
    table.add({{std::string(term)},
               {fmt::format("{:.0f}", found)},
               {expected > 0 ? fmt::format("{:.4g}", expected) : ""},
               {expected > 0 ? fmt::format("{:.2f}", expected / found) : ""},
               {std::string(meaning(term))}});
  }
  return table.text(screen);
}

}  // namespace

AnswerRow run_row(Json inputs, const validate::Job& job, const RunAnswer& answer, bool alone) {
  Json json = answer_json(job, answer);
  const Whole measured = measured_whole(job, answer);
  json["whole_measured"] = alone ? whole_json(measured.seconds) : Json();
  json["peak_bytes_measured"] = alone && measured.peak_bytes ? Json(*measured.peak_bytes) : Json();
  Json cells = run_cells(inputs, answer, json);
  return {std::move(inputs), std::move(json), {std::move(cells)}};
}

Columns run_columns() {
  return workload_columns() + Columns{"estimator", "paths", "engine", "threads"} + candidate_columns() +
         Columns{"k",
                 "k_max",
                 "k_best",
                 "k_published",
                 "k_corrected",
                 "photons",
                 "hits_per_disc",
                 "mean_irradiance",
                 "mean_irradiance_error",
                 "missed_share",
                 "missed_share_bound"} +
         count_columns() + count_columns("predicted_") +
         Columns{"rebuild_time", "intersect_time", "predicted_rebuild_time", "predicted_intersect_time"} +
         Columns{"predicted_seconds",
                 "predicted_seconds_again",
                 "predicted_seconds_error",
                 "choosing_seconds",
                 "seconds",
                 "prepare_seconds",
                 "order_seconds",
                 "build_seconds",
                 "search_seconds",
                 "timed_runs",
                 "read_seconds",
                 "trace_seconds",
                 "rays_in_memory",
                 "whole_seconds",
                 "whole_measured_seconds",
                 "peak_bytes",
                 "peak_bytes_measured",
                 "stopped",
                 "hits_so_far",
                 "hits_estimate",
                 "hits_estimate_error",
                 "noise",
                 "noise_low",
                 "noise_high",
                 "error",
                 "error_low",
                 "error_high",
                 "bias_estimate",
                 "bias_low",
                 "bias_high",
                 "mean_bias",
                 "confidence",
                 "stopped_because",
                 "until_seconds"} +
         effect_columns();
}

TextColumns run_text_columns(const Screen& screen) {
  return {{"scene", "field", "ray_file", "front_facing", "seed", "rays", "samples", "disc_radius", "estimator", "paths",
           "engine", "technique", "parameters"},
          {"hits", "rebuild_time", "predicted_rebuild_time", "intersect_time", "predicted_intersect_time", "seconds",
           "predicted_seconds"},
          screen,
          "rebuild_time: T_R at t = 1, tests of rays against spheres or boxes. intersect_time: T_I at u = 1, tests "
          "against discs. Both as in detp model, whose unit costs are 1."};
}

std::vector<std::string> answer_warnings(const validate::Job& job, const RunAnswer& answer) {
  std::vector<std::string> all;
  if (answer.taken && answer.taken->light) all = sim::light_warnings(*answer.taken->light, job.lights);
  if (!answer.run.outcome.stopped && answer.run.outcome.total_hits == 0) all.push_back(why_nothing(job, answer));
  if (const sim::MissedShare& missed = answer.run.missed; missed.upper_bound > 0)
    all.push_back(
        fmt::format("{:.2g} % of the light on surfaces is missing, at most {:.2g} % (95 %, {} photons): it comes from "
                    "point, spot or directional lights by way of mirrors, gloss or glass, where no backward path "
                    "finds it; --estimator area-corrected has it",
                    100 * missed.share, 100 * missed.upper_bound, missed.photons));
  return all;
}

std::string to_text(const validate::Job& job, const RunAnswer& answer, const Screen& screen, bool verbose) {
  const Timing& timing = answer.timing;
  std::string text;
  if (answer.until) text += wrapped(until_text(*answer.until, scene_side(job.given)), screen.text_width(), 10);
  text += wrapped(describe_given(job, taken_by(job, answer)), screen.text_width(), 10);
  const auto add = [&](const std::string& line) { text += wrapped(line, screen.text_width(), 10); };
  if (answer.estimator != sim::Estimator::disc)
    add(fmt::format(
        "estimator {}{}{}", name(answer.estimator),
        gathers(answer)
            ? fmt::format(", {} backward paths per disc and side (hits: those that bring light)", answer.paths)
            : "",
        has_technique(answer) ? "" : fmt::format(", {}", threads_text(answer.threads))));
  if (has_technique(answer))
    add(fmt::format("technique {}, {} engine, {}", title(answer.candidate), name(answer.engine),
                    threads_text(answer.threads)) +
        (!answer.choice         ? ""
         : is_predicted(answer) ? fmt::format(", chosen in {:.2g} ms by a pilot of {} rays",
                                              1e3 * answer.choice->choosing_seconds, answer.choice->sampled_rays)
                                : ", by the numbers of rays and discs: a pilot would take longer than it saves"));
  if (verbose && !gathers(answer)) add(effects_line(job.observed().effects));
  add("hits      " + hits_text(job, answer));
  for (const std::string& one : answer_warnings(job, answer)) add("warning   " + one);
  add(fmt::format("seconds   {:.4g}: prepare {:.3g}, order {:.3g}, build {:.3g}, search {:.3g}{}", timing.total(),
                  timing.prepare, timing.phases.order, timing.phases.build, timing.phases.search,
                  repeats_text(timing)));
  add(whole_line(predicted_whole(job, answer, job.given), measured_whole(job, answer)));
  if (answer.form)
    if (const std::string formulas = formulas_text(job, answer); !formulas.empty()) add(formulas);
  if (const auto& seconds = answer.run.rank_seconds; !seconds.empty())
    add(fmt::format(
        "ranks     {} processes share the {}, {:.3g} to {:.3g} s each; the slowest took {:.2g} % more than the mean",
        seconds.size(), answer.run.share == sim::Share::rays ? "rays" : "discs", *std::ranges::min_element(seconds),
        *std::ranges::max_element(seconds), 100 * sim::imbalance(seconds)));
  return verbose ? text + "\n" + counts_table(job, answer, screen) : text;
}

}  // namespace detp::cli
