#include "calibration_file.hpp"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "built_in_costs.hpp"
#include "cache_file.hpp"
#include "detp/sim/files/file_error.hpp"
#include "detp/sim/files/input_file.hpp"

namespace detp::validate {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view schema = "detp.calibrate";
constexpr std::size_t most_bytes = std::size_t{1} << 20;

std::string today() {
  const std::chrono::year_month_day day(std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now()));
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(day.year()), static_cast<unsigned>(day.month()),
                     static_cast<unsigned>(day.day()));
}

/// Costs that the file does not name are 0; techniques that it does not name have the built-in costs.
CostTable costs_of(const Json& json) {
  CostTable costs = built_in_unit_costs();
  for (const Technique technique : all_techniques) {
    const auto found = json.find(std::string(name(technique)));
    if (found == json.end()) continue;
    for (const UnitCostTerm& term : unit_cost_terms)
      costs[technique].*term.cost = found->value(std::string(term.symbol), 0.0);
  }
  check(costs);
  return costs;
}

Json to_json(const CostTable& costs) {
  Json json;
  for (const Technique technique : all_techniques)
    if (record_of(technique).exact || technique == Technique::sphere_cache_published)
      for (const UnitCostTerm& term : unit_cost_terms)
        if (const double cost = costs[technique].*term.cost; cost > 0)
          json[std::string(name(technique))][std::string(term.symbol)] = cost;
  return json;
}

}  // namespace

std::string calibration_text(const Calibration& calibration) {
  const Json json{{"schema", {{"name", schema}, {"version", 1}}},
                  {"key", to_json(this_machine())},
                  {"date", today()},
                  {"left_out_median_error", calibration.left_out_median_error},
                  {"costs", to_json(calibration.costs)}};
  return json.dump(2) + "\n";
}

std::string default_calibration_path() { return cache_path("calibration.json"); }

void write_calibration(const std::string& path, const Calibration& calibration) {
  write_cache_file(path, calibration_text(calibration));
}

StoredCalibration parse_calibration(const std::string& text, const std::string& path) {
  try {
    const Json json = Json::parse(text);
    if (json.at("schema").at("name") != schema || json.at("schema").at("version") != 1)
      throw sim::FileError(path, "is not a calibration of this version of detp; make one with detp calibrate");
    StoredCalibration stored{.key = key_of(json.at("key")),
                             .date = json.at("date"),
                             .costs = costs_of(json.at("costs")),
                             .left_out_median_error = json.at("left_out_median_error")};
    require_non_negative("left_out_median_error", stored.left_out_median_error);
    return stored;
  } catch (const nlohmann::json::exception& error) {
    throw sim::FileError(
        path, fmt::format("is not a calibration: {}; make one with detp calibrate", shortened(error.what(), 150)));
  } catch (const std::invalid_argument& error) {
    throw sim::FileError(path, fmt::format("is not a calibration: {}", error.what()));
  }
}

StoredCalibration read_calibration(const std::string& path) {
  return parse_calibration(sim::read_file(path, most_bytes), path);
}

}  // namespace detp::validate
