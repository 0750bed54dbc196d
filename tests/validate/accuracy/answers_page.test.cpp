#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "detp/validate/statistics/statistics.hpp"
#include "support/pages.hpp"

namespace detp::support {
namespace {

/// An answer of `detp accuracy`, and all that was found about it.
struct Answer {
  CsvRow row;
  std::vector<CsvRow> rivals;    ///< the best way of each other estimator
  std::vector<CsvRow> runs;      ///< the answer run again with other seeds
  std::vector<CsvRow> commands;  ///< its command, each time as a process of its own
};

bool same_question(const CsvRow& a, const CsvRow& b) {
  return std::ranges::all_of(std::array{"scene", "target_kind", "target"},
                             [&](const char* key) { return a.at(key) == b.at(key); });
}

std::vector<Answer> published_answers() {
  std::vector<Answer> answers;
  for (const CsvRow& row : published("accuracy_answers.csv")) {
    const std::string& role = row.at("role");
    if (role == "answer") {
      answers.push_back({row, {}, {}, {}});
      continue;
    }
    const auto own = std::ranges::find_if(answers, [&](const Answer& one) { return same_question(one.row, row); });
    REQUIRE(own != answers.end());
    (role == "rival" ? own->rivals : role == "run" ? own->runs : own->commands).push_back(row);
  }
  return answers;
}

std::vector<double> column(const std::vector<CsvRow>& rows, const std::string& name) {
  std::vector<double> values;
  for (const CsvRow& row : rows)
    if (!row.at(name).empty()) values.push_back(number(row, name));
  return values;
}

/// "area-corrected (disc 3.1 ×)", or what comes nearest.
std::string first_words(const Answer& answer) {
  const std::string estimator = answer.row.at("estimator");
  if (answer.row.at("reached") != "true")
    return fmt::format("none; {} {:.2g} %", estimator, 100 * number(answer.row, "error"));
  for (const CsvRow& rival : answer.rivals)
    if (rival.at("reached") == "true")
      return fmt::format("{} ({} {:.2g} ×)", estimator, rival.at("estimator"),
                         number(rival, "predicted_seconds") / number(answer.row, "predicted_seconds"));
  return estimator + " only";
}

std::string first_line(const std::string& scene, const std::vector<Answer>& answers) {
  std::string line = "| " + scene + " |";
  for (const char* target : {"0.1", "0.05", "0.02"})
    for (const Answer& answer : answers)
      if (answer.row.at("scene") == scene && answer.row.at("target_kind") == "error" &&
          answer.row.at("target") == target)
        line += " " + first_words(answer) + " |";
  return line;
}

/// The median total error of the runs, of the run to check if there are no others, or nothing.
std::optional<double> total_found(const Answer& answer) {
  std::vector<double> runs = column(answer.runs, "measured_error");
  if (runs.empty()) runs = column({answer.row}, "measured_error");
  return runs.empty() ? std::nullopt : std::optional(validate::median(runs));
}

bool total_inside(const Answer& answer) {
  const double found = *total_found(answer);
  return found >= number(answer.row, "error_low") && found <= number(answer.row, "error_high");
}

std::string cell(const std::vector<double>& values, double scale, const char* unit) {
  return values.empty() ? "–" : fmt::format("{:.2g}{}", scale * validate::median(values), unit);
}

std::string check_line(const Answer& answer) {
  const CsvRow& row = answer.row;
  const std::string total = answer.runs.empty() ? "–" : fmt::format("{:.2g} %", 100 * *total_found(answer));
  return fmt::format("| {} | {} | {:.2g} | {} | {} | {:.2g} % | {} | {:.2g} % ({:.2g} to {:.2g}) | {} |",
                     row.at("scene"), row.at("estimator"), number(row, "predicted_seconds"),
                     cell(column({row}, "measured_seconds"), 1, ""),
                     cell(column(answer.commands, "measured_seconds"), 1, ""), 100 * number(row, "noise"),
                     cell(column(answer.runs, "measured_noise"), 100, " %"), 100 * number(row, "error"),
                     100 * number(row, "error_low"), 100 * number(row, "error_high"), total);
}

std::string ratio_words(const std::vector<double>& ratios) {
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", validate::median(ratios), validate::quantile(ratios, 0),
                     validate::quantile(ratios, 1));
}

}  // namespace

TEST_SUITE("figures") {
  TEST_CASE("the page's answers in scenes are those of accuracy_answers.csv") {
    const std::string page = source_text("validate/accuracy/README.md");
    const auto answers = published_answers();
    std::set<std::string> scenes;
    std::vector<double> first;
    std::vector<double> command;
    std::vector<double> noise;
    std::vector<double> price;
    for (const Answer& answer : answers) {
      const CsvRow& row = answer.row;
      scenes.insert(row.at("scene"));
      const double check = row.at("measured_seconds").empty() ? 0 : number(row, "measured_seconds");
      if (check > 0)  // the check had other rays than the answer that it changed
        first.push_back(number(row, "predicted_seconds") / (check * number(row, "correction")));
      if (!answer.commands.empty()) {
        const double seconds = validate::median(column(answer.commands, "measured_seconds"));
        command.push_back(number(row, "predicted_seconds") / seconds);
        price.push_back((number(row, "planning_seconds") - check) / seconds);
      }
      if (!answer.runs.empty())
        noise.push_back(number(row, "noise") / validate::median(column(answer.runs, "measured_noise")));
    }
    REQUIRE(scenes.size() == 10);
    for (const std::string& scene : scenes) check_says(page, first_line(scene, answers));
    std::size_t found = 0;
    std::size_t found_inside = 0;
    std::vector<double> totals;  // found over predicted, of answers that reach a total error
    for (const Answer& answer : answers) {
      if (answer.row.at("target_kind") == "noise") check_says(page, check_line(answer));
      if (answer.row.at("target_kind") != "error" || !total_found(answer)) continue;
      ++found;
      found_inside += total_inside(answer) ? 1 : 0;
      if (answer.row.at("reached") == "true") totals.push_back(*total_found(answer) / number(answer.row, "error"));
    }
    check_says(page, fmt::format("inside its interval in {} of {} answers", found_inside, found));
    const auto says = [&](const char* what, const std::vector<double>& ratios) {
      check_says(page, fmt::format("| {} | {} | {} |", what, ratios.size(), ratio_words(ratios)));
    };
    const auto deviation = [](std::vector<double> ratios) {
      for (double& ratio : ratios) ratio = std::abs(ratio - 1);
      return validate::median(ratios);
    };
    check_says(page, fmt::format("the median deviation from the command is {:.0f} %", 100 * deviation(command)));
    const auto within =
        std::ranges::count_if(first, [](double ratio) { return std::abs(std::log(ratio)) <= std::log(1.5); });
    check_says(page, fmt::format("{} of {} first runs took within a factor of 1.5 of the predicted seconds", within,
                                 first.size()));
    says("total error, found over predicted, where it is reached", totals);
    says("seconds, run to check", first);
    says("seconds, its command", command);
    says("noise, runs with other seeds", noise);
    says("planning, over the seconds of its command", price);
  }
}

}  // namespace detp::support
