#include "choose_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "extrapolated.hpp"
#include "measured_report.hpp"
#include "table.hpp"
#include "workload_options.hpp"

namespace detp::cli {
namespace {

struct Row {
  Candidate candidate;
  const model::Ranked* predicted = nullptr;
  const validate::Analysed* run = nullptr;
  bool chosen = false;
};

/// The number of threads of the row's prediction and runs.
int threads_of(const Row& row) { return row.run != nullptr ? row.run->threads : row.predicted->threads; }

/// Rows in the order of the ranking. After an analysis, the other candidates that were tried follow.
std::vector<Row> rows_of(const ChooseAnswer& answer) {
  std::vector<Row> rows;
  if (!answer.analysis) {
    for (const model::Ranked& ranked : answer.ranking) rows.push_back({ranked.candidate, &ranked});
    rows.front().chosen = true;
    return rows;
  }
  for (const validate::Analysed& run : answer.analysis->candidates)
    rows.push_back({run.candidate, run.predicted ? &*run.predicted : nullptr, &run});
  rows[answer.analysis->best.value_or(0)].chosen = true;
  return rows;
}

std::string largest_part(const CostBreakdown& time) {
  const std::array<std::pair<double, const char*>, 6> parts{{{time.order, "sorting samples"},
                                                             {time.build, "building the index"},
                                                             {time.rebuild, "ray-sphere tests"},
                                                             {time.copy, "copying lists"},
                                                             {time.traverse, "stepping through the index"},
                                                             {time.intersect, "ray-disc tests"}}};
  return std::max_element(parts.begin(), parts.end())->second;
}

std::string why_not(const ChooseAnswer& answer, const Row& row) {
  if (row.run != nullptr && answer.analysis->best) {
    const double fastest = *answer.analysis->candidates[*answer.analysis->best].seconds;
    if (row.run->seconds) return fmt::format("measured {:.3g}x slower", *row.run->seconds / fastest);
    if (row.run->given_up_after)
      return fmt::format("took over {:.3g}x as long and was given up", *row.run->given_up_after / fastest);
  }
  if (row.predicted == nullptr) return "not measured, and it has no closed form";
  const CostBreakdown& time = row.predicted->time;
  if (time.total() < answer.ranking.front().time.total())
    return "predicted faster, but within the error of closed forms or unit costs";
  return fmt::format("predicted {:.3g}x slower, mostly {}", time.total() / answer.ranking.front().time.total(),
                     largest_part(time));
}

/// Candidates whose times differ by less than this cannot be told apart: the error of unit costs.
constexpr double distinguishable = 0.15;

/// The pilot's standard error of the row's time, seconds; nothing if a pilot did not predict it.
std::optional<double> error_of(const ChooseAnswer& answer, const Row& row) {
  if (!answer.pilot) return std::nullopt;
  for (const validate::Piloted& one : answer.pilot->candidates)
    if (one.candidate == row.candidate) return one.error;
  return std::nullopt;
}

bool could_win(const ChooseAnswer& answer, const Row& row) {
  return row.predicted->time.total() < (1 + distinguishable) * answer.ranking.front().time.total();
}

Json candidate_json(const ChooseAnswer& answer, const Row& row) {
  Json json{{"technique", name(row.candidate.technique)},
            {"parameters", to_json(row.candidate)},
            {"threads", threads_of(row)}};
  if (row.predicted != nullptr) {
    json["predicted"] = to_json(row.predicted->counts);
    json["predicted_seconds"] = row.predicted->time.total();
    json["tuned"] = row.predicted->tuned;
    json.update(extrapolated_json(row.predicted->extrapolated));
    if (const auto error = error_of(answer, row)) {
      json["predicted_seconds_error"] = *error;
      json["could_still_win"] = could_win(answer, row);
    }
  }
  if (!row.chosen) json["why_not"] = why_not(answer, row);
  if (row.run != nullptr) add_measured(json, *answer.analysis, *row.run);
  return json;
}

Json choice_json(const ChooseAnswer& answer, const Row& row) {
  Json json{{"technique", name(row.candidate.technique)},
            {"parameters", to_json(row.candidate)},
            {"threads", threads_of(row)}};
  if (row.predicted != nullptr) {
    json["predicted_seconds"] = row.predicted->time.total();
    if (const auto error = error_of(answer, row)) json["predicted_seconds_error"] = *error;
    json.update(extrapolated_json(row.predicted->extrapolated));
  }
  if (row.run != nullptr && row.run->seconds) {
    json["measured_seconds"] = *row.run->seconds;
    json["measured_spread"] = row.run->spread;
  }
  return json;
}

/// Why techniques that are not among the candidates were not considered.
void add_left_out(Json& json, const validate::PilotChoice& pilot) {
  json["ruled_out"] = Json::array();
  for (const validate::RuledOut& one : pilot.ruled_out)
    json["ruled_out"].push_back(
        {{"technique", name(one.technique)}, {one.by_bound ? "at_least_seconds" : "predicted_seconds", one.seconds}});
  json["not_examined"] = Json::array();
  for (const Technique technique : pilot.unexamined) json["not_examined"].push_back(name(technique));
}

}  // namespace

Json to_json(const ChooseAnswer& answer) {
  const std::vector<Row> rows = rows_of(answer);
  const Row& chosen = *std::find_if(rows.begin(), rows.end(), [](const Row& row) { return row.chosen; });
  Json json{{"choice", choice_json(answer, chosen)},
            {"candidates", Json::array()},
            {"paper_rule",
             {{"technique", name(answer.paper.candidate.technique)},
              {"parameters", to_json(answer.paper.candidate)},
              {"threads", answer.paper.threads},
              {"predicted_seconds", answer.paper.time.total()}}},
            {"effects", effects_json(answer.workload)},
            {"rigor", name(answer.rigor)},
            {"engine", name(answer.costs.engine)},
            {"unit_costs", answer.costs_origin},
            {"choosing_seconds",
             {{"total", answer.choosing_seconds},
              {"evidence", answer.evidence_seconds},
              {"pilot", answer.pilot ? answer.pilot->pilot_seconds : 0}}},
            {"choosing_share", answer.choosing_seconds / answer.ranking.front().time.total()},
            {"warnings", answer.warnings}};
  if (answer.pilot) add_left_out(json, *answer.pilot);
  json["paper_rule"].update(extrapolated_json(answer.paper.extrapolated));
  for (const Row& row : rows) json["candidates"].push_back(candidate_json(answer, row));
  if (answer.analysis) add_analysis(json, answer);
  return json;
}

namespace {

/// Two cells: the row's predicted time divided by that of the first candidate, and the name of the largest part of the
/// row's predicted time. For instance "3.5" and "ray-disc tests".
std::vector<TextCell> comparison_cells(const ChooseAnswer& answer, const Row& row) {
  const CostBreakdown& time = row.predicted->time;
  return {{fmt::format("{:.3g}", time.total() / answer.ranking.front().time.total())}, {largest_part(time)}};
}

/// "no, 3.4 times", "yes, 2 %", or nothing for the choice.
std::vector<TextCell> pilot_cells(const ChooseAnswer& answer, const Row& row) {
  if (row.chosen) return {{}};
  const double ratio = row.predicted->time.total() / answer.ranking.front().time.total();
  const std::string more = ratio < 2 ? fmt::format("{:+.2g} %", 100 * (ratio - 1)) : fmt::format("{:.3g} times", ratio);
  return {{fmt::format("{}, {}", could_win(answer, row) ? "yes" : "no", more)}};
}

std::string verdict(const ChooseAnswer& answer, const Row& row) {
  if (row.chosen) return "<- choice";
  if (row.run == nullptr || row.run->seconds) return "";
  Json json;
  add_measured(json, *answer.analysis, *row.run);
  return json["not_run"];
}

std::string table(const ChooseAnswer& answer, const Screen& screen) {
  std::vector<TextColumn> columns{{.head = "technique", .align = Align::left},
                                  {.head = "parameters", .align = Align::left},
                                  {.head = "threads", .spare = 2},
                                  {.head = "tests", .spare = 1, .group = "predicted"},
                                  {.head = "seconds", .align = Align::left, .group = "predicted"}};
  if (answer.analysis)
    for (const TextColumn& column : measured_table_columns()) columns.push_back(column);
  else if (answer.pilot)
    columns.push_back({.head = "could still win", .align = Align::left});
  else
    columns.insert(columns.end(),
                   {{.head = "times the first", .spare = 3}, {.head = "mostly", .align = Align::left, .spare = 2}});
  columns.push_back({.head = "", .align = Align::left});
  TextTable table(std::move(columns));
  for (const Row& row : rows_of(answer)) {
    const Style style = row.chosen ? Style::good : Style::plain;
    std::vector<TextCell> cells{{std::string(name(row.candidate.technique)), style},
                                {describe(row.candidate), style},
                                {fmt::format("{}", threads_of(row))}};
    if (row.predicted != nullptr) {
      const char* const mark = row.predicted->extrapolated.empty() ? "" : "~";
      cells.push_back({fmt::format("{:.3g}", tests(row.predicted->counts))});
      const double error = error_of(answer, row).value_or(0);
      cells.push_back({fmt::format("{:.3g}{}{}", row.predicted->time.total(), mark,
                                   error > 0 ? fmt::format(" ± {:.1g}", error) : "")});
    }
    cells.resize(5);
    for (const TextCell& cell : answer.analysis ? measured_cells(*row.run)
                                : answer.pilot  ? pilot_cells(answer, row)
                                                : comparison_cells(answer, row))
      cells.push_back(cell);
    cells.push_back({verdict(answer, row), row.chosen ? Style::good : Style::faint});
    table.add(std::move(cells));
  }
  return "\n" + table.text(screen);
}

std::string notes(const ChooseAnswer& answer, const Screen& screen) {
  std::vector<std::pair<Technique, std::vector<std::string>>> predictions;
  for (const Row& row : rows_of(answer))
    if (row.predicted != nullptr) predictions.emplace_back(row.candidate.technique, row.predicted->extrapolated);
  std::string text =
      "tests: of a ray against a sphere, a box or a disc. X: distance between neighbouring samples over d. D: "
      "dimension "
      "of the samples, 2 on surfaces, 3 in a volume. Q, k: ratio of the radii of nested spheres, their number. r0: "
      "radius of the sphere around all discs.";
  if (answer.analysis)
    text +=
        " ± of measured seconds: half the range of the timed runs; none where there was one run. !: predicted seconds "
        "off by more than a factor of two.";
  if (answer.pilot)
    text +=
        " ± of predicted seconds: standard error of the pilot. Could still win: less than 15 % slower than the choice, "
        "which is about the error of unit costs.";
  const std::string extrapolated = extrapolated_note(predictions);
  return (extrapolated.empty() ? "" : wrapped(extrapolated, screen.text_width(), 2)) + legend(screen, text);
}

/// The least predicted time of a technique other than the choice; nothing if there is none.
std::optional<std::pair<Technique, double>> next_technique(const ChooseAnswer& answer) {
  const Technique chosen = answer.ranking.front().candidate.technique;
  std::optional<std::pair<Technique, double>> next;
  const auto consider = [&](Technique technique, double seconds) {
    if (technique != chosen && (!next || seconds < next->second)) next = {technique, seconds};
  };
  for (const model::Ranked& ranked : answer.ranking) consider(ranked.candidate.technique, ranked.time.total());
  if (answer.pilot)
    for (const validate::RuledOut& one : answer.pilot->ruled_out) consider(one.technique, one.seconds);
  return next;
}

std::string margin(const ChooseAnswer& answer) {
  const double seconds = answer.ranking.front().time.total();
  const double error = answer.pilot ? answer.pilot->choice().error : 0;
  const std::string predicted =
      fmt::format("predicted {:.3g}{} s", seconds, error > 0 ? fmt::format(" ± {:.1g}", error) : "");
  const auto next = next_technique(answer);
  if (!next) return predicted + ", no other technique";
  const double times = next->second / seconds;
  if (times < 1)
    return fmt::format("{}; {} may be faster: predicted {:.3g} s", predicted, name(next->first), next->second);
  return answer.pilot ? fmt::format("{}, at least {:.2f} times faster than any other technique{}", predicted, times,
                                    answer.pilot->unexamined.empty() ? "" : " that was examined")
                      : fmt::format("{}, {:.2f} times faster than {}", predicted, times, name(next->first));
}

std::string ruled_out_line(const validate::PilotChoice& pilot) {
  std::string list;
  for (const validate::RuledOut& one : pilot.ruled_out)
    list += fmt::format("{}{} ({}{:.2g} s)", list.empty() ? "" : ", ", name(one.technique),
                        one.by_bound ? "at least " : "", one.seconds);
  return "ruled out " + (list.empty() ? "none" : list);
}

std::string not_examined_line(const validate::PilotChoice& pilot) {
  std::string list;
  for (const Technique technique : pilot.unexamined) list += (list.empty() ? "" : ", ") + std::string(name(technique));
  return "unknown   " + list + ": to find out would take longer than it could save";
}

std::string how_chosen(const ChooseAnswer& answer) {
  const std::string run =
      answer.rigor == Rigor::measure ? fmt::format("{} candidates run; before that, ", answer.analysis->tried) : "";
  if (!answer.pilot) return run + "closed forms alone";
  if (!answer.pilot->discs) return run + "no pilot, because sorting the discs would take longer than brute force";
  const std::string sample = answer.rigor == Rigor::structural
                                 ? fmt::format("{} {} of the field, not those of the run", answer.pilot->sampled_rays,
                                               answer.workload.path_length > 0 ? "segments" : "lines")
                                 : fmt::format("{} of {:.6g} rays", answer.pilot->sampled_rays, answer.workload.rays);
  return fmt::format("{}{}, through parts of the tree of boxes; the discs that it sorted are kept", run, sample);
}

std::string effects_line(const Workload& workload) {
  std::string on;
  std::string off;
  for (const Json& effect : effects_json(workload)) {
    std::string& list = effect["on"].get<bool>() ? on : off;
    list += (list.empty() ? "" : ", ") + effect["name"].get<std::string>();
  }
  return fmt::format("effects   on: {}; off: {}", on.empty() ? "none" : on, off.empty() ? "none" : off);
}

}  // namespace

std::string to_text(const ChooseAnswer& answer, const Screen& screen) {
  std::string text = wrapped(answer.title, screen.text_width(), 10);
  const auto add = [&](const std::string& line) { text += wrapped(line, screen.text_width(), 10); };
  add(effects_line(answer.workload));
  text += table(answer, screen) + notes(answer, screen) + "\n";
  const double fastest = answer.ranking.front().time.total();
  if (!answer.analysis || !answer.analysis->best)
    text += choice_text(fmt::format("{}, {}: {}", title(answer.ranking.front().candidate),
                                    threads_text(answer.ranking.front().threads), margin(answer)),
                        screen);
  if (answer.analysis) text += measured_lines(answer, screen);
  if (answer.pilot) add(ruled_out_line(*answer.pilot));
  if (answer.pilot && !answer.pilot->unexamined.empty()) add(not_examined_line(*answer.pilot));
  add(fmt::format("paper     its rule takes {}: predicted {:.3g} s, {:.3g} times as long as the predicted choice",
                  title(answer.paper.candidate), answer.paper.time.total(), answer.paper.time.total() / fastest));
  const double share = answer.choosing_seconds / fastest;
  add(fmt::format("planning  {:.2g} ms ({} the predicted run), rigor {}: {}", 1e3 * answer.choosing_seconds,
                  share < 1 ? fmt::format("{:.2g} % of", 100 * share) : fmt::format("{:.3g} times", share),
                  name(answer.rigor), how_chosen(answer)));
  add(fmt::format("costs     {}; engine {}", answer.costs_origin, name(answer.costs.engine)));
  return text;
}

namespace {

Json cells_of(const model::Ranked& ranked) {
  Json cells = candidate_cells(ranked.candidate);
  cells["threads"] = ranked.threads;
  cells.update(count_cells(ranked.counts, "predicted_"));
  cells["predicted_seconds"] = ranked.time.total();
  cells["extrapolated"] = !ranked.extrapolated.empty();
  cells["extrapolated_because"] = joined(ranked.extrapolated);
  return cells;
}

Json cells_of(const ChooseAnswer& answer, const Row& row) {
  Json cells = row.predicted != nullptr ? cells_of(*row.predicted) : candidate_cells(row.candidate);
  const Json json = candidate_json(answer, row);
  for (const char* name : {"threads", "predicted_seconds_error", "could_still_win", "measured_seconds",
                           "measured_spread", "given_up_after_seconds", "not_run", "why_not"})
    if (json.contains(name)) cells[name] = json[name];
  if (row.run == nullptr) return cells;
  if (row.run->counted) cells.update(count_cells(*row.run->counted, "counted_"));
  cells.update(missed_ratios(*row.run, answer.costs));
  return cells;
}

const char* role_of(const ChooseAnswer& answer, const Row& row, bool first) {
  if (row.chosen) return "choice";
  return first && answer.analysis ? "predicted choice" : "candidate";
}

}  // namespace

std::string to_csv(const ChooseAnswer& answer, const Json& inputs) {
  const Columns of_all{"tried", "regret", "rigor", "unit_costs", "choosing_seconds"};
  Table table(workload_columns() + effect_columns() + Columns{"warnings", "role"} + candidate_columns() +
              Columns{"engine", "threads"} + count_columns("predicted_") +
              Columns{"predicted_seconds", "predicted_seconds_error", "could_still_win", "extrapolated",
                      "extrapolated_because"} +
              count_columns("counted_") +
              Columns{"measured_seconds", "measured_spread", "given_up_after_seconds", "not_run", "why_not",
                      "seconds_ratio", "counts_ratio", "unit_costs_ratio", "worst_count", "worst_count_ratio"} +
              of_all);
  Json shared = workload_cells(inputs);
  const Json json = to_json(answer);
  shared.update(effect_cells(json["effects"]));
  shared["warnings"] = joined(answer.warnings);
  shared["engine"] = name(answer.costs.engine);
  for (const std::string& name : of_all)
    if (json.contains(name)) shared[name] = json[name];
  shared["choosing_seconds"] = answer.choosing_seconds;
  const auto add = [&](const char* role, const Json& cells) {
    Json row = shared;
    row["role"] = role;
    row.update(cells);
    table.add(row);
  };
  const std::vector<Row> rows = rows_of(answer);
  for (const Row& row : rows) {
    add(role_of(answer, row, &row == &rows.front()), cells_of(answer, row));
  }
  add("paper rule", cells_of(answer.paper));
  return table.csv();
}

}  // namespace detp::cli
