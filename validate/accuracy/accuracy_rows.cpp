#include "accuracy_rows.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "detp/sim/estimate/estimator.hpp"

namespace detp::validate {
namespace {

struct AccuracyColumn {
  const char* name;
  double AccuracyRow::*value;
};

constexpr std::array accuracy_numbers{AccuracyColumn{"radius_over_distance", &AccuracyRow::radius},
                                      AccuracyColumn{"nearest", &AccuracyRow::nearest},
                                      AccuracyColumn{"rays", &AccuracyRow::rays},
                                      AccuracyColumn{"photons", &AccuracyRow::photons},
                                      AccuracyColumn{"noise", &AccuracyRow::noise},
                                      AccuracyColumn{"noise_low", &AccuracyRow::noise_low},
                                      AccuracyColumn{"noise_high", &AccuracyRow::noise_high},
                                      AccuracyColumn{"bias", &AccuracyRow::bias},
                                      AccuracyColumn{"bias_low", &AccuracyRow::bias_low},
                                      AccuracyColumn{"bias_high", &AccuracyRow::bias_high},
                                      AccuracyColumn{"total", &AccuracyRow::total},
                                      AccuracyColumn{"total_low", &AccuracyRow::total_low},
                                      AccuracyColumn{"total_high", &AccuracyRow::total_high},
                                      AccuracyColumn{"within_5_percent", &AccuracyRow::within},
                                      AccuracyColumn{"error_95", &AccuracyRow::error_95},
                                      AccuracyColumn{"worst", &AccuracyRow::worst},
                                      AccuracyColumn{"trace_seconds", &AccuracyRow::trace_seconds},
                                      AccuracyColumn{"estimate_seconds", &AccuracyRow::estimate_seconds},
                                      AccuracyColumn{"reference_error", &AccuracyRow::reference_error}};

constexpr double many_rays = 1e6;
constexpr double some_seconds = 1;

/// With the rays that the time allows: seconds grow in proportion.
double total_in(const AccuracyRow& row, double seconds) { return total_with(row, row.rays * seconds / row.seconds()); }

/// The row with the least error among those that `allowed` admits.
template <class Error, class Allowed>
const AccuracyRow* best(const std::vector<AccuracyRow>& rows, const Error& error, const Allowed& allowed) {
  const AccuracyRow* found = nullptr;
  for (const AccuracyRow& row : rows)
    if (allowed(row) && (found == nullptr || error(row) < error(*found))) found = &row;
  return found;
}

std::string cell(const AccuracyRow* row, double total) {
  if (row == nullptr) return "";
  const std::string setting = row->setting();
  return fmt::format("{:.1f} %{}", 100 * total, setting.empty() ? "" : fmt::format(" ({})", setting));
}

}  // namespace

std::string AccuracyRow::setting() const {
  if (radius > 0) return fmt::format("d = {:g} h", radius);
  return nearest > 0 ? fmt::format("k = {:g}", nearest) : "";
}

std::string accuracy_header() {
  std::string header = "scene,estimator,reference";
  for (const AccuracyColumn& column : accuracy_numbers) header += fmt::format(",{}", column.name);
  return header + "\n";
}

std::string csv_row(const AccuracyRow& row) {
  std::string text = fmt::format("{},{},{}", row.scene, row.estimator, row.reference);
  for (const AccuracyColumn& column : accuracy_numbers) text += fmt::format(",{:.6g}", row.*column.value);
  return text + "\n";
}

std::vector<AccuracyRow> read_accuracy_rows(std::istream& csv) {
  std::vector<AccuracyRow> rows;
  std::string line;
  if (!std::getline(csv, line)) return rows;
  if (line + "\n" != accuracy_header()) throw std::invalid_argument("not a table of the accuracy study: " + line);
  while (std::getline(csv, line)) {
    std::vector<std::string> fields;
    std::istringstream text(line);
    for (std::string field; std::getline(text, field, ',');) fields.push_back(field);
    if (fields.size() != 3 + accuracy_numbers.size())
      throw std::invalid_argument("not a row of the accuracy study: " + line);
    AccuracyRow row;
    row.scene = fields[0];
    row.estimator = fields[1];
    row.reference = fields[2];
    for (std::size_t i = 0; i < accuracy_numbers.size(); ++i) row.*accuracy_numbers[i].value = std::stod(fields[3 + i]);
    rows.push_back(std::move(row));
  }
  return rows;
}

double total_with(const AccuracyRow& row, double rays) {
  return std::sqrt(row.bias * row.bias + row.noise * row.noise * row.rays / rays);
}

std::string accuracy_summary(const std::vector<AccuracyRow>& rows) {
  std::vector<std::string> scenes;
  std::vector<std::string> estimators;
  for (const AccuracyRow& row : rows) {
    if (std::ranges::find(scenes, row.scene) == scenes.end()) scenes.push_back(row.scene);
    if (row.estimator != name(sim::Estimator::gather) &&
        std::ranges::find(estimators, row.estimator) == estimators.end())
      estimators.push_back(row.estimator);
  }
  const auto table = [&](const std::string& title, const auto& error) {
    std::string text =
        fmt::format("\n{}\n\n| scene | {} | disc, d = h/2 |\n|---|{}---|\n", title, fmt::join(estimators, " | "),
                    fmt::join(std::vector<std::string>(estimators.size(), "---|"), ""));
    for (const std::string& scene : scenes) {
      text += fmt::format("| {} |", scene);
      for (const std::string& estimator : estimators) {
        const AccuracyRow* row = best(rows, error, [&](const AccuracyRow& one) {
          return one.scene == scene && one.estimator == estimator && one.rays == many_rays;
        });
        text += fmt::format(" {} |", cell(row, row == nullptr ? 0 : error(*row)));
      }
      const AccuracyRow* half = best(rows, error, [&](const AccuracyRow& one) {
        return one.scene == scene && one.estimator == "disc" && one.rays == many_rays && one.radius == 0.5;
      });
      text += half == nullptr ? " |\n" : fmt::format(" {:.1f} % |\n", 100 * error(*half));
    }
    return text;
  };
  return table("Least total error with 10⁶ pieces of photon paths (h: sample distance)",
               [](const AccuracyRow& row) { return row.total; }) +
         table("Least total error in one second, tracing included",
               [](const AccuracyRow& row) { return total_in(row, some_seconds); });
}

}  // namespace detp::validate
