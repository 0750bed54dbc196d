#include "calibration_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "built_in_costs.hpp"
#include "detp/sim/files/file_error.hpp"
#include "detp/sim/files/input_file.hpp"
#include "detp/sim/files/output_file.hpp"
#include "detp/sim/lists/simd/tree_search.hpp"

namespace detp::validate {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view schema = "detp.calibrate";
constexpr int cost_model = 3;  // change it whenever the meaning of a unit cost or of a count changes
constexpr std::size_t most_bytes = std::size_t{1} << 20;

std::string cpu_name() {
  std::ifstream cpus("/proc/cpuinfo");
  for (std::string line; std::getline(cpus, line);)
    if (line.starts_with("model name") && line.find(": ") != std::string::npos) return line.substr(line.find(": ") + 2);
  return "unknown";
}

std::string today() {
  const std::chrono::year_month_day day(std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now()));
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(day.year()), static_cast<unsigned>(day.month()),
                     static_cast<unsigned>(day.day()));
}

Json to_json(const CalibrationKey& key) {
  return {{"cpu", key.cpu},           {"instruction_set", key.instruction_set},
          {"caches", key.caches},     {"threads", key.threads},
          {"compiler", key.compiler}, {"cost_model", key.cost_model}};
}

CalibrationKey key_of(const Json& json) {
  return {.cpu = json.at("cpu"),
          .instruction_set = json.at("instruction_set"),
          .caches = json.at("caches"),
          .threads = json.at("threads"),
          .compiler = json.at("compiler"),
          .cost_model = json.at("cost_model")};
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
  if (const int found = json.at("key").at("cost_model"); found != cost_model)
    throw sim::FileError(path, fmt::format("is of version {} of the cost model, here it is {}, with costs of both "
                                           "engines and of threads; make a new one with detp calibrate",
                                           found, cost_model));
}

}  // namespace

CalibrationKey this_machine() {
  return {.cpu = cpu_name(),
          .instruction_set = sim::stream::instruction_set(),
          .caches = fmt::format("{} {} {}", sysconf(_SC_LEVEL1_DCACHE_SIZE), sysconf(_SC_LEVEL2_CACHE_SIZE),
                                sysconf(_SC_LEVEL3_CACHE_SIZE)),
          .threads = static_cast<int>(std::thread::hardware_concurrency()),
          .compiler = __VERSION__,
          .cost_model = cost_model};
}

std::string difference(const CalibrationKey& stored, const CalibrationKey& here) {
  const auto differ = [](std::string_view what, const auto& there, const auto& at_hand) {
    return there == at_hand ? "" : fmt::format("its {} is {}, here it is {}", what, there, at_hand);
  };
  for (const std::string& text :
       {differ("cpu", stored.cpu, here.cpu), differ("instruction set", stored.instruction_set, here.instruction_set),
        differ("cache sizes", stored.caches, here.caches), differ("number of threads", stored.threads, here.threads),
        differ("compiler", stored.compiler, here.compiler),
        differ("version of the cost model", stored.cost_model, here.cost_model)})
    if (!text.empty()) return shortened(text, 300);
  return "";
}

std::string default_calibration_path() {
  const auto folder = [](const char* variable) {
    const char* value = std::getenv(variable);
    return value != nullptr && value[0] == '/' ? std::filesystem::path(value) : std::filesystem::path();
  };
  std::filesystem::path cache = folder("XDG_CACHE_HOME");
  if (cache.empty() && !folder("HOME").empty()) cache = folder("HOME") / ".cache";
  return cache.empty() ? "" : (cache / "detp" / "calibration.json").string();
}

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

void write_calibration(const std::string& path, const Calibration& calibration) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code failed;
  if (!folder.empty()) std::filesystem::create_directories(folder, failed);
  if (failed) throw sim::FileError(folder.string(), fmt::format("cannot be made: {}", failed.message()));
  sim::OutputFile file(path);
  file.write(calibration_text(calibration));
  file.commit();
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
