#include "calibration_file.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "built_in_costs.hpp"
#include "detp/sim/files/file_error.hpp"
#include "detp/sim/files/input_file.hpp"
#include "detp/sim/files/output_file.hpp"
#include "detp/validate/base/json.hpp"

namespace detp::validate {
namespace {

constexpr std::string_view schema = "detp.calibrate";
constexpr std::size_t most_bytes = std::size_t{1} << 20;
constexpr double most_seconds = 1;  ///< of an operation
constexpr double most_error = 100;  ///< relative; of a calibration that is of any use

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

/// A time or error above this is none of any machine, and predictions with it might overflow.
void require_possible(const std::string& what, double value, double most) {
  require_non_negative(what, value);
  if (value > most) throw std::invalid_argument(fmt::format("{} must be at most {} (got {})", what, most, value));
}

UnitCosts unit_costs_of(const Json& units, Technique technique) {
  UnitCosts costs;
  bool some = false;
  for (const UnitCostTerm& term : unit_cost_terms) {
    double& cost = costs.*term.cost;
    cost = units.value(std::string(term.symbol), 0.0);
    require_possible(fmt::format("unit cost {} of {}", term.symbol, name(technique)), cost, most_seconds);
    some = some || cost > 0;
  }
  if (!some) throw std::invalid_argument(fmt::format("it has no unit costs of {}", name(technique)));
  return costs;
}

/// The costs of one engine, which must name all exact techniques. Unit costs that the file does not name are 0. Costs of
/// threads that it does not name are the built-in ones.
CostTable costs_of(const Json& json, Engine engine, const CalibrationQuality& quality) {
  CostTable costs = built_in_unit_costs(engine);
  const std::string engine_name(name(engine));
  const Json& units = json.at("costs").at(engine_name);
  const Json& threads = json.at("threads").at(engine_name);
  const Json errors = json.at("relative_errors").at(engine_name);
  for (const Technique technique : all_techniques) {
    const std::string key(name(technique));
    if (record_of(technique).exact || units.contains(key))
      costs[technique] = unit_costs_of(units.value(key, Json::object()), technique);
    if (const auto found = threads.find(key); found != threads.end())
      for (const ThreadTerm& term : thread_terms) {
        double& cost = costs.threads_of(technique).*term.cost;
        cost = found->at(term.name);
        require_possible(fmt::format("{} of {}", term.name, name(technique)), cost, most_seconds);  // or a share
      }
    double& error = costs.relative_error_of(technique);
    error = errors.value(key, quality.relative_error());
    require_possible("relative error of " + key, error, most_error);
  }
  check(costs);
  return costs;
}

Json costs_json(const CostTable& costs) {
  Json json;
  for (const Technique technique : all_techniques)
    if (record_of(technique).exact || technique == Technique::sphere_cache_published)
      for (const UnitCostTerm& term : unit_cost_terms)
        if (const double cost = costs[technique].*term.cost; cost > 0)
          json[std::string(name(technique))][std::string(term.symbol)] = cost;
  return json;
}

Json errors_json(const CostTable& costs) {
  Json json = Json::object();
  for (const Technique technique : exact_techniques)
    json[std::string(name(technique))] = costs.relative_error_of(technique);
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

/// Of what a calibration has. The result of detp calibrate, which is read too, has more.
std::string checksum_of_costs(const Json& json) {
  Json members;
  for (const char* name :
       {"key", "date", "left_out_median_error", "processor_share", "relative_errors", "costs", "threads"})
    members[name] = json.at(name);
  return checksum(members);
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

/// A file that detp did not make.
bool is_foreign(const std::string& path) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown) || std::filesystem::is_empty(path, unknown)) return false;
  const Json json = Json::parse(sim::read_file(path, most_bytes), nullptr, false);
  return !json.is_object() || json.value("schema", Json::object()).value("name", Json()) != schema;
}

/// detp/NAME in $XDG_CACHE_HOME, or in ~/.cache if that is not set to an absolute path; empty if there is no home either.
std::string cache_path(const std::string& name) {
  const auto folder = [](const char* variable) {
    const char* value = std::getenv(variable);
    return value != nullptr && value[0] == '/' ? std::filesystem::path(value) : std::filesystem::path();
  };
  std::filesystem::path cache = folder("XDG_CACHE_HOME");
  if (cache.empty() && !folder("HOME").empty()) cache = folder("HOME") / ".cache";
  return cache.empty() ? "" : (cache / "detp" / name).string();
}

/// Replaces the file as a whole, and makes its folder if necessary. Throws sim::FileError.
void write_cache_file(const std::string& path, const std::string& text) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code failed;
  if (!folder.empty()) std::filesystem::create_directories(folder, failed);
  if (failed) throw sim::FileError(folder.string(), fmt::format("cannot be made: {}", failed.message()));
  sim::OutputFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace

Json calibration_json(const Calibration& calibration) {
  const auto of_engines = [&](Json (*json_of_costs)(const CostTable&)) {
    return Json{{"simd", json_of_costs(calibration.simd)}, {"plain", json_of_costs(calibration.plain)}};
  };
  Json json{{"schema", {{"name", schema}, {"version", 1}}},
            {"key", to_json(this_machine())},
            {"date", today()},
            {"left_out_median_error", calibration.left_out_median_error},
            {"processor_share", calibration.processor_share},
            {"relative_errors", of_engines(errors_json)},
            {"costs", of_engines(costs_json)},
            {"threads", of_engines(threads_json)}};
  json["checksum"] = checksum_of_costs(json);
  if (calibration.probe) json["probe"] = true;
  return json;
}

std::string calibration_text(const Calibration& calibration) { return calibration_json(calibration).dump(2) + "\n"; }

std::string default_calibration_path() { return cache_path("calibration.json"); }
std::string probe_path() { return cache_path("probe.json"); }

void write_calibration(const std::string& path, const Calibration& calibration) {
  write_cache_file(path, calibration_text(calibration));
}

std::string save_calibration(const std::string& path, const Calibration& calibration) {
  if (const std::string doubt = calibration.doubt(); !doubt.empty())
    if (const auto stored = find_calibration(path); stored && stored->is_better_than(calibration))
      return fmt::format("this calibration is doubtful: {}; that of {}, whose median error is {:.2g} %, is kept", doubt,
                         stored->date, 100 * stored->left_out_median_error);
  if (is_foreign(path)) return fmt::format("{} is not a calibration and stays as it is; delete it", path);
  write_calibration(path, calibration);
  return "";
}

std::optional<Calibration> find_calibration(const std::string& path, std::string* why_not) {
  std::string ignored;
  std::string& reason = why_not != nullptr ? *why_not : ignored;
  reason.clear();
  std::error_code unknown;  // a file that cannot be looked at is not used
  if (path.empty() || !std::filesystem::exists(path, unknown)) return std::nullopt;
  try {
    Calibration stored = read_calibration(path);
    const std::string differs = difference(stored.key, this_machine());
    if (differs.empty()) return stored;
    reason = fmt::format("{}: {}", path, differs);
  } catch (const sim::FileError& error) {
    reason = error.what();
  }
  return std::nullopt;
}

std::optional<Calibration> stored_calibration(std::string* why_not) {
  if (auto stored = find_calibration(default_calibration_path(), why_not)) return stored;
  return find_calibration(probe_path());
}

CostTable stored_unit_costs(Engine engine) {
  const auto stored = stored_calibration();
  return stored ? stored->of(engine) : built_in_unit_costs(engine);
}

Calibration parse_calibration(const std::string& text, const std::string& path) {
  try {
    const Json json = Json::parse(text);
    check_version(json, path);
    Calibration stored;
    stored.key = key_of(json.at("key"));
    stored.date = json.at("date");
    stored.left_out_median_error = json.at("left_out_median_error");
    require_possible("left_out_median_error", stored.left_out_median_error, most_error);
    stored.processor_share = json.at("processor_share");
    require_share("processor_share", stored.processor_share);
    stored.probe = json.value("probe", false);
    stored.plain = costs_of(json, Engine::plain, stored);
    stored.simd = costs_of(json, Engine::simd, stored);
    if (json.value("checksum", "") != checksum_of_costs(json))
      throw sim::FileError(path,
                           "was altered, or is of an earlier version of detp: it does not fit its checksum; make "
                           "a new one with detp calibrate");
    return stored;
  } catch (const nlohmann::json::exception& error) {
    throw sim::FileError(
        path, fmt::format("is not a calibration: {}; make one with detp calibrate", shortened(error.what(), 150)));
  } catch (const std::invalid_argument& error) {
    throw sim::FileError(path, fmt::format("is not a calibration: {}", error.what()));
  }
}

Calibration read_calibration(const std::string& path) {
  return parse_calibration(sim::read_file(path, most_bytes), path);
}

}  // namespace detp::validate
