#include "choose_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "table.hpp"
#include "workload_options.hpp"

namespace detp::cli {
namespace {

const validate::Analysed* analysed(const ChooseAnswer& answer, std::size_t place) {
  return answer.analysis ? &answer.analysis->candidates[place] : nullptr;
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

std::string why_not(const ChooseAnswer& answer, std::size_t place) {
  if (place == 0) return "";
  const CostBreakdown& time = answer.ranking[place].time;
  return fmt::format("predicted {:.3g}x slower, mostly {}", time.total() / answer.ranking.front().time.total(),
                     largest_part(time));
}

Json candidate_json(const ChooseAnswer& answer, std::size_t place) {
  const model::Ranked& ranked = answer.ranking[place];
  Json json{{"technique", name(ranked.candidate.technique)},
            {"parameters", to_json(ranked.candidate.parameters)},
            {"predicted", to_json(ranked.counts)},
            {"predicted_seconds", ranked.time.total()}};
  if (place > 0) json["why_not"] = why_not(answer, place);
  if (const auto* run = analysed(answer, place)) {
    if (run->counted) json["counted"] = to_json(*run->counted);
    if (run->seconds) {
      json["measured_seconds"] = *run->seconds;
      json["measured_spread"] = run->spread;
    } else {
      json["not_run"] = answer.analysis->stopped ? "stopped before" : "predicted over 30x slower than the choice";
    }
  }
  return json;
}

}  // namespace

Json to_json(const ChooseAnswer& answer) {
  const model::Ranked& best = answer.ranking.front();
  Json json{{"choice",
             {{"technique", name(best.candidate.technique)},
              {"parameters", to_json(best.candidate.parameters)},
              {"predicted_seconds", best.time.total()}}},
            {"candidates", Json::array()},
            {"paper_rule",
             {{"technique", name(answer.paper.candidate.technique)},
              {"parameters", to_json(answer.paper.candidate.parameters)},
              {"predicted_seconds", answer.paper.time.total()}}},
            {"effects", effects_json(answer.workload)},
            {"rigor", answer.rigor},
            {"unit_costs", !answer.costs_given ? "built-in; not calibrated on this machine" : "given"},
            {"choosing_seconds", answer.choosing_seconds}};
  for (std::size_t place = 0; place < answer.ranking.size(); ++place)
    json["candidates"].push_back(candidate_json(answer, place));
  if (answer.analysis) {
    if (answer.analysis->regret) json["regret"] = *answer.analysis->regret;
    json["stopped"] = answer.analysis->stopped;
  }
  return json;
}

namespace {

std::string measured_columns(const ChooseAnswer& answer, std::size_t place) {
  const auto* run = analysed(answer, place);
  if (run == nullptr) return "";
  if (!run->counted)
    return answer.analysis->stopped ? "  (stopped before)" : "  (not run: predicted over 30x the choice)";
  std::string text = fmt::format("  {:>9.3g}", static_cast<double>(tests(*run->counted)));
  if (!run->seconds) return text + "  (stopped before)";
  const double ratio = answer.ranking[place].time.total() / *run->seconds;
  return text + fmt::format("  {:>8.3g} ±{:<8.1g}  {:>6.2f}{}", *run->seconds, run->spread, ratio,
                            ratio > 2 || ratio < 0.5 ? " !" : "  ");
}

std::string table(const ChooseAnswer& answer) {
  const bool measured = answer.analysis.has_value();
  std::string text = fmt::format("\n{:41} {:>20}{}\n", "", "predicted",
                                 measured ? "    counted  measured             predicted/" : "");
  text += fmt::format("{:14} {:26} {:>10} {:>9}{}\n", "technique", "parameters", "tests", "seconds",
                      measured ? "      tests  seconds              measured" : "");
  for (std::size_t place = 0; place < answer.ranking.size(); ++place) {
    const model::Ranked& ranked = answer.ranking[place];
    text += fmt::format("{:14} {:26} {:>10.3g} {:>9.3g}{}{}\n", name(ranked.candidate.technique),
                        describe(ranked.candidate.parameters), tests(ranked.counts), ranked.time.total(),
                        measured_columns(answer, place), place == 0 ? "  <- choice" : "");
  }
  return text;
}

std::string margin(const ChooseAnswer& answer) {
  if (answer.ranking.size() < 2) return "no other candidate";
  return fmt::format("predicted {:.2f}x ahead of {}", answer.ranking[1].time.total() / answer.ranking[0].time.total(),
                     name(answer.ranking[1].candidate.technique));
}

std::string regret_line(const validate::Analysis& analysis) {
  if (!analysis.regret) return "regret    unknown: the choice was not timed\n";
  const char* partial = analysis.stopped ? " (stopped: not all were timed)" : "";
  if (*analysis.regret <= 0) return fmt::format("regret    none: the choice was the fastest measured{}\n", partial);
  return fmt::format("regret    {:.1f} %: the fastest measured took {:.3g} of the choice's time{}\n",
                     100 * *analysis.regret, 1 / (1 + *analysis.regret), partial);
}

}  // namespace

std::string to_text(const ChooseAnswer& answer) {
  std::string text = answer.title;
  std::string on;
  for (const Json& effect : effects_json(answer.workload))
    if (effect["on"].get<bool>()) on += (on.empty() ? "" : ", ") + effect["name"].get<std::string>();
  text += fmt::format("effects   on: {}\n", on.empty() ? "none" : on);
  text += table(answer);
  text += fmt::format("\nchoice    {} {}: {}\n", name(answer.ranking[0].candidate.technique),
                      describe(answer.ranking[0].candidate.parameters), margin(answer));
  text += fmt::format("paper     its rule takes {} {}: predicted {:.3g} s\n", name(answer.paper.candidate.technique),
                      describe(answer.paper.candidate.parameters), answer.paper.time.total());
  if (answer.analysis) text += regret_line(*answer.analysis);
  text += fmt::format(
      "rigor     {}: {}, in {:.2g} ms; unit costs {}\n", answer.rigor,
      answer.rigor == "structural" ? "parameters by closed forms, counts by the structures built with them"
                                   : "closed forms",
      1e3 * answer.choosing_seconds, !answer.costs_given ? "built in, not calibrated on this machine" : "as given");
  return text;
}

namespace {

Json cells_of(const model::Ranked& ranked) {
  Json cells = candidate_cells(ranked.candidate);
  cells.update(count_cells(ranked.counts, "predicted_"));
  cells["predicted_seconds"] = ranked.time.total();
  return cells;
}

Json cells_of(const ChooseAnswer& answer, std::size_t place) {
  Json cells = cells_of(answer.ranking[place]);
  const Json json = candidate_json(answer, place);
  for (const char* name : {"measured_seconds", "measured_spread", "not_run", "why_not"})
    if (json.contains(name)) cells[name] = json[name];
  if (const auto* run = analysed(answer, place); run != nullptr && run->counted)
    cells.update(count_cells(*run->counted, "counted_"));
  return cells;
}

}  // namespace

std::string to_csv(const ChooseAnswer& answer, const Json& inputs) {
  Table table(workload_columns() + Columns{"role"} + candidate_columns() + count_columns("predicted_") +
              Columns{"predicted_seconds"} + count_columns("counted_") +
              Columns{"measured_seconds", "measured_spread", "not_run", "why_not", "regret", "rigor", "unit_costs",
                      "choosing_seconds"});
  Json shared = workload_cells(inputs);
  const Json json = to_json(answer);
  for (const char* name : {"regret", "rigor", "unit_costs", "choosing_seconds"})
    if (json.contains(name)) shared[name] = json[name];
  const auto add = [&](const char* role, const Json& cells) {
    Json row = shared;
    row["role"] = role;
    row.update(cells);
    table.add(row);
  };
  for (std::size_t place = 0; place < answer.ranking.size(); ++place)
    add(place == 0 ? "choice" : "candidate", cells_of(answer, place));
  add("paper rule", cells_of(answer.paper));
  return table.csv();
}

}  // namespace detp::cli
