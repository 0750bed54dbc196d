#include "run_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/ranked/ranked.hpp"
#include "detp/validate/cli/report/effects_report.hpp"
#include "detp/validate/cli/report/prediction_report.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/table.hpp"

namespace detp::cli {
namespace {

using validate::RunAnswer;

std::string percent_words(double share) { return fmt::format("{:.2g} %", 100 * share); }

std::string_view how_it_ended(validate::StopReason reason) {
  using enum validate::StopReason;
  return reason == target ? " is reached."
         : reason == bias ? " is not reached: the bias alone is as large, and more rays do not help."
         : reason == rays ? " is not reached: there are no more rays."
                          : " was not reached when the run was stopped.";
}

/// The first lines of the text.
std::string until_text(const validate::Job& job, const RunAnswer& answer) {
  const validate::UntilAnswer& until = *answer.until;
  const validate::UntilResult& result = until.result;
  const validate::ErrorTarget& asked = answer.request.target->error;
  const std::string of_band = job.bands.empty() ? "" : " of " + answer.request.target->band.value_or("all bands");
  const std::string target =
      percent_words(asked.error) + (answer.request.target->total ? " error" : " noise") + of_band;
  std::string text = "answer    ";
  if (result.share_bound)
    text += fmt::format("no {} met a disc: fewer than {:.2g} of {:.3g} photons do ({} confidence). ",
                        job.bands.empty() ? "photon" : "light" + of_band, *result.share_bound * result.photons,
                        result.photons, percent_words(asked.confidence));
  else
    text +=
        fmt::format("{} noise{}, at most {} with {} confidence, after {:.3g} rays ({:.3g} photons) and {:.2g} s. ",
                    percent_words(result.noise.value), of_band, percent_words(result.noise.high),
                    percent_words(asked.confidence), static_cast<double>(result.rays), result.photons, until.seconds);
  text += target + std::string(how_it_ended(result.reason)) + " ";
  if (!until.bias) return text + "\n";
  const validate::RootInterval bias = until.bias->interval();
  text += fmt::format("The bias at this radius is {}, the total {} ({} to {}), by {}.",
                      bias.low > 0 ? fmt::format("{} ({} to {})", percent_words(bias.value), percent_words(bias.low),
                                                 percent_words(bias.high))
                                   : "at most " + percent_words(bias.high),
                      percent_words(until.error().value), percent_words(until.error().low),
                      percent_words(until.error().high), until.bias->by);
  if (until.bias->squared.mean > asked.error * asked.error)
    text += until.bias->radius > 0
                ? fmt::format(
                      " More rays do not lower it; {} needs a radius of at most {:.3g} ({:.2g} % of the scene).",
                      percent_words(asked.error), until.bias->radius, 100 * until.bias->radius / scene_side(job.given))
                : " More rays do not lower it, nor does a quarter of the radius: detp accuracy compares estimators.";
  return text + "\n";
}

std::string with_error(const std::optional<double>& standard_error) {
  return standard_error ? fmt::format(" ± {:.2g}", *standard_error) : " (error not known)";
}

double hits_per_disc(const RunAnswer& answer) {
  return static_cast<double>(answer.run.outcome.total_hits) / static_cast<double>(disc_count(answer.run));
}

/// "0.5", or "r 0.5, g 0.25".
std::string by_band(const validate::Job& job, const std::vector<double>& values) {
  if (job.bands.empty()) return fmt::format("{:.6g}", values.front());
  std::string text;
  for (std::size_t band = 0; band < values.size(); ++band)
    text += fmt::format("{}{} {:.6g}", band == 0 ? "" : ", ", job.bands[band], values[band]);
  return text;
}

std::string hits_text(const validate::Job& job, const RunAnswer& answer) {
  const sim::Outcome& outcome = answer.run.outcome;
  if (!outcome.stopped)
    return fmt::format("{}, {:.4g} a disc; mean irradiance {}", outcome.total_hits, hits_per_disc(answer),
                       by_band(job, validate::mean_irradiance(answer.run)));
  std::string text =
      fmt::format("{} of the {} {} done", outcome.total_hits, outcome.progress.done, outcome.progress.unit);
  if (const auto all = validate::estimated_hits(answer)) {
    text += fmt::format("; of all rays an estimated {:.5g}", all->value);
    text += with_error(all->standard_error);
  }
  const std::vector<sim::SumEstimate> means = validate::estimated_irradiance(job, answer);
  for (std::size_t band = 0; band < means.size(); ++band)
    text += fmt::format("; mean irradiance by all{} an estimated {:.6g}{}",
                        job.bands.empty() ? "" : " in " + job.bands[band], means[band].value,
                        with_error(means[band].standard_error));
  return text;
}

/// "on floor 1.2 ± 0.1, on walls 0.8 ± 0.1", brightest first; of several bands their sums.
std::string light_text(const validate::LightOnParts& light) {
  struct Part {
    double light;
    double error;
    const std::string* name;
  };
  std::vector<Part> parts;
  for (std::size_t part = 0; part < light.parts.names.size(); ++part) {
    Part one{0, 0, &light.parts.names[part]};
    for (std::size_t band = 0; band < light.found.bands(); ++band) {
      const sim::DiscResult found = sim::result_of(light.found, part, band);
      one.light += light.parts.areas[part] * found.irradiance;
      one.error += light.parts.areas[part] * found.standard_error;  // bands share their photons
    }
    parts.push_back(one);
  }
  std::ranges::sort(parts, std::greater{}, &Part::light);
  constexpr std::size_t most = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, parts.size()); ++i)
    text += fmt::format("{}on {} {:.4g}{}", i == 0 ? "" : ", ", *parts[i].name, parts[i].light,
                        parts[i].error < sim::unbounded ? fmt::format(" ± {:.2g}", parts[i].error) : "");
  return text + (parts.size() > most ? fmt::format(" and on {} others", parts.size() - most) : "");
}

/// Empty if there were fewer than two timed runs.
std::string repeats_text(const validate::Timing& timing) {
  if (timing.all.size() < 2) return "";
  const auto [least, most] = std::minmax_element(timing.all.begin(), timing.all.end());
  return fmt::format("; median of {} runs, ± {:.1g} (half their range)", timing.all.size(), 0.5 * (*most - *least));
}

std::string over(double predicted, double counted) {
  return fmt::format("{:.4g} counted, {:.4g} predicted ({:.2f})", counted, predicted, predicted / counted);
}

/// "formulas  T_R …; T_I …", for who asked for a form; empty without a prediction.
std::string formulas_text(const validate::Job& job, const RunAnswer& answer) {
  const auto predicted = validate::prediction(job.workload(), answer);
  if (!predicted || answer.run.outcome.stopped) return "";
  const CostBreakdown expected = price(*predicted, UnitCosts{}, answer.candidate.technique);
  const CostBreakdown found = price(as_expected(answer.run.outcome.counts), UnitCosts{}, answer.candidate.technique);
  std::string text = fmt::format("formulas  {}, in tests: ", name(answer.request.form.value()));
  if (found.rebuild > 0) text += fmt::format("T_R {}; ", over(expected.rebuild, found.rebuild));
  if (found.traverse > 0) text += fmt::format("nodes {}; ", over(expected.traverse, found.traverse));
  if (found.intersect > 0) text += fmt::format("T_I {}", over(expected.intersect, found.intersect));
  const auto* cache = std::get_if<SphereCacheParameters>(&answer.candidate.parameters);
  if (cache == nullptr) return text;
  const std::int64_t own = model::own_spheres(job.workload(), *answer.request.form, {cache->ratio});
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
  const auto predicted = validate::prediction(job.workload(), answer);
  const Counts<std::uint64_t> counts = validate::counted(answer);
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

std::string picture_text(const validate::Picture& picture, const validate::SeenBetween& seen, const Screen& screen) {
  const auto& [from, to] = seen;
  return wrapped(fmt::format("picture   {}: --view {:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}", shown_path(picture.path),
                             from.x, from.y, from.z, to.x, to.y, to.z),
                 screen.text_width(), 10);
}

std::string to_text(const validate::Job& job, const RunAnswer& answer, const Whole& measured, const Screen& screen,
                    bool verbose) {
  const validate::Timing& timing = answer.timing;
  std::string text;
  if (answer.until) text += wrapped(until_text(job, answer), screen.text_width(), 10);
  text += wrapped(describe_given(job, validate::taken_by(job, answer)), screen.text_width(), 10);
  const auto add = [&](const std::string& line) { text += wrapped(line, screen.text_width(), 10); };
  if (answer.request.estimator != sim::Estimator::disc)
    add(fmt::format(
        "estimator {}{}{}", name(answer.request.estimator),
        answer.request.gathers()
            ? fmt::format(", {} backward paths per disc and side (hits: those that bring light)", answer.request.paths)
            : "",
        answer.request.has_technique() ? "" : fmt::format(", {}", threads_text(answer.threads))));
  if (answer.request.has_technique())
    add(fmt::format("technique {}, {} engine, {}", title(answer.candidate), name(answer.request.engine),
                    threads_text(answer.threads)) +
        (!answer.choice        ? ""
         : answer.is_piloted() ? fmt::format(", chosen in {:.2g} ms by a pilot of {} rays",
                                             1e3 * answer.choice->choosing_seconds, answer.choice->sampled_rays)
                               : ", by the numbers of rays and discs: a pilot would take longer than it saves"));
  if (verbose && !answer.request.gathers()) add(effects_line(job.observed().effects));
  add("hits      " + hits_text(job, answer));
  if (answer.faces)
    for (const validate::LightOnParts* one : {&answer.faces->by_material, &answer.faces->by_group})
      if (!one->parts.names.empty()) add("faces     light " + light_text(*one));
  for (const std::string& one : validate::answer_warnings(job, answer)) add("warning   " + one);
  add(fmt::format("seconds   {:.4g}: prepare {:.3g}, order {:.3g}, build {:.3g}, search {:.3g}{}", timing.total(),
                  timing.prepare, timing.phases.order, timing.phases.build, timing.phases.search,
                  repeats_text(timing)));
  add(whole_line(validate::predicted_whole(job, answer, job.given), measured));
  if (answer.request.form)
    if (const std::string formulas = formulas_text(job, answer); !formulas.empty()) add(formulas);
  if (const auto& seconds = answer.run.rank_seconds; !seconds.empty())
    add(fmt::format(
        "ranks     {} processes share the {}, {:.3g} to {:.3g} s each; the slowest took {:.2g} % more than the mean",
        seconds.size(), answer.run.share == sim::Share::rays ? "rays" : "discs", *std::ranges::min_element(seconds),
        *std::ranges::max_element(seconds), 100 * sim::imbalance(seconds)));
  return verbose ? text + "\n" + counts_table(job, answer, screen) : text;
}

}  // namespace detp::cli
