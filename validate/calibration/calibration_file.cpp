#include "calibration_file.hpp"

#include <fmt/format.h>

#include <array>
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

struct ThreadTerm {
  const char* name;
  double ThreadCosts::*cost;
};
constexpr std::array thread_terms{ThreadTerm{"serial_preparing", &ThreadCosts::serial_preparing},
                                  ThreadTerm{"serial_search", &ThreadCosts::serial_search},
                                  ThreadTerm{"start", &ThreadCosts::start}};

/// The costs of one engine. Unit costs that the file does not name are 0; techniques that it does not name have the
/// built-in costs.
CostTable costs_of(const Json& json, Engine engine) {
  CostTable costs = built_in_unit_costs(engine);
  const Json& units = json.at("costs").at(std::string(name(engine)));
  const Json& threads = json.at("threads").at(std::string(name(engine)));
  for (const Technique technique : all_techniques) {
    const std::string key(name(technique));
    if (const auto found = units.find(key); found != units.end())
      for (const UnitCostTerm& term : unit_cost_terms)
        costs[technique].*term.cost = found->value(std::string(term.symbol), 0.0);
    if (const auto found = threads.find(key); found != threads.end())
      for (const ThreadTerm& term : thread_terms) costs.threads_of(technique).*term.cost = found->at(term.name);
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

/// Of the techniques that threads can make faster.
Json threads_json(const CostTable& costs) {
  Json json = Json::object();
  for (const Technique technique : all_techniques)
    if (const ThreadCosts& one = costs.threads_of(technique); one != ThreadCosts{})
      for (const ThreadTerm& term : thread_terms) json[std::string(name(technique))][term.name] = one.*term.cost;
  return json;
}

void check_version(const Json& json, const std::string& path) {
  if (json.at("schema").at("name") != schema || json.at("schema").at("version") != 1)
    throw sim::FileError(path, "is not a calibration of this version of detp; make one with detp calibrate");
  const int cost_model = this_machine().cost_model;
  if (const int found = json.at("key").at("cost_model"); found != cost_model)
    throw sim::FileError(path, fmt::format("is of version {} of the cost model, here it is {}, with costs of both "
                                           "engines and of threads; make a new one with detp calibrate",
                                           found, cost_model));
}

}  // namespace

std::string calibration_text(const Calibration& calibration) {
  const Json json{
      {"schema", {{"name", schema}, {"version", 1}}},
      {"key", to_json(this_machine())},
      {"date", today()},
      {"left_out_median_error", calibration.left_out_median_error},
      {"costs", {{"simd", to_json(calibration.simd.costs)}, {"plain", to_json(calibration.plain.costs)}}},
      {"threads", {{"simd", threads_json(calibration.simd.costs)}, {"plain", threads_json(calibration.plain.costs)}}}};
  return json.dump(2) + "\n";
}

std::string default_calibration_path() { return cache_path("calibration.json"); }

void write_calibration(const std::string& path, const Calibration& calibration) {
  write_cache_file(path, calibration_text(calibration));
}

StoredCalibration parse_calibration(const std::string& text, const std::string& path) {
  try {
    const Json json = Json::parse(text);
    check_version(json, path);
    StoredCalibration stored{.key = key_of(json.at("key")),
                             .date = json.at("date"),
                             .plain = costs_of(json, Engine::plain),
                             .simd = costs_of(json, Engine::simd),
                             .left_out_median_error = json.at("left_out_median_error")};
    require_non_negative("left_out_median_error", stored.left_out_median_error);
    constexpr double median_of_normal = 0.6745;  // of the absolute values, in standard deviations
    stored.simd.relative_error = stored.plain.relative_error = stored.left_out_median_error / median_of_normal;
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
