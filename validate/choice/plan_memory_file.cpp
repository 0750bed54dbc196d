#include "plan_memory_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "candidate_json.hpp"
#include "detp/sim/files/file_error.hpp"
#include "detp/sim/files/input_file.hpp"
#include "detp/sim/files/output_file.hpp"
#include "detp/validate/calibration/cache_file.hpp"
#include "detp/validate/calibration/calibration_key_json.hpp"

namespace detp::validate {
namespace {

using MemoryJson = nlohmann::ordered_json;

constexpr std::string_view memory_schema = "detp.plans";
constexpr std::size_t most_memory_bytes = std::size_t{1} << 24;

struct ClassTerm {
  const char* name;
  int WorkloadClass::*term;
};

constexpr ClassTerm class_terms[] = {{"log2_rays", &WorkloadClass::rays},
                                     {"log2_discs", &WorkloadClass::discs},
                                     {"half_log2_spacing", &WorkloadClass::spacing},
                                     {"quarter_dimension", &WorkloadClass::dimension},
                                     {"log2_path_length", &WorkloadClass::path_length}};

MemoryJson to_json(const PlanMemory::Entry& entry) {
  MemoryJson workload = MemoryJson::object();
  for (const ClassTerm& term : class_terms) workload[term.name] = entry.workload.*term.term;
  workload["front_facing"] = entry.workload.front_facing;
  const RememberedChoice& choice = entry.choice;
  return {{"workload", workload},
          {"technique", name(choice.candidate.technique)},
          {"parameters", to_json(choice.candidate)},
          {"threads", choice.threads},
          {"predicted_seconds", choice.predicted_seconds},
          {"predicted_seconds_error", choice.predicted_error},
          {"rigor", name(choice.rigor)},
          {"cut_off", choice.cut_off}};
}

int whole_number(const MemoryJson& json) {
  const auto number = json.get<double>();
  require_count("a whole number of a choice", number + 1e6, 0, 2e6);
  return static_cast<int>(number);
}

PlanMemory::Entry entry_of(const MemoryJson& json) {
  PlanMemory::Entry entry;
  for (const ClassTerm& term : class_terms) entry.workload.*term.term = whole_number(json.at("workload").at(term.name));
  entry.workload.front_facing = json.at("workload").at("front_facing").get<bool>();
  const auto technique = technique_named(json.at("technique").get<std::string>());
  const auto rigor = choice_named<Rigor>(json.at("rigor").get<std::string>());
  if (!technique || !rigor) throw std::invalid_argument("it names an unknown technique or rigor");
  entry.choice = {.candidate = candidate_of(*technique, json.at("parameters")),
                  .threads = whole_number(json.at("threads")),
                  .predicted_seconds = json.at("predicted_seconds").get<double>(),
                  .predicted_error = json.at("predicted_seconds_error").get<double>(),
                  .rigor = *rigor,
                  .cut_off = json.at("cut_off").get<bool>()};
  return entry;
}

/// Throws std::invalid_argument or nlohmann::json::exception; then the memory may have some of the choices.
std::string add_choices(const MemoryJson& json, PlanMemory& memory) {
  if (json.at("schema").at("name") != memory_schema || json.at("schema").at("version") != 1)
    return "is not a memory of plans of this version of detp";
  const std::string differs = difference(key_of(json.at("key")), this_machine());
  if (!differs.empty()) return differs;
  for (const MemoryJson& one : json.at("plans")) {
    const PlanMemory::Entry entry = entry_of(one);
    memory.remember(entry.workload, entry.choice);
  }
  return "";
}

}  // namespace

std::string default_plan_memory_path() { return cache_path("plans.json"); }

std::string plan_memory_text(const PlanMemory& memory) {
  MemoryJson json{{"schema", {{"name", memory_schema}, {"version", 1}}}, {"key", to_json(this_machine())}};
  json["plans"] = MemoryJson::array();
  for (const PlanMemory::Entry& entry : memory.entries()) json["plans"].push_back(to_json(entry));
  return json.dump(2, ' ', false, MemoryJson::error_handler_t::replace) + "\n";
}

void write_plan_memory(const std::string& path, const PlanMemory& memory) {
  write_cache_file(path, plan_memory_text(memory));
}

std::string parse_plan_memory(const std::string& text, const std::string& path, PlanMemory& memory) {
  const auto not_used = [&](const std::string& why) { return fmt::format("{}: not used: {}", shown_path(path), why); };
  try {
    PlanMemory read;  // filled first, so that nothing of a broken file is used
    const std::string refused = add_choices(MemoryJson::parse(text), read);
    if (!refused.empty()) return not_used(refused);
    for (const PlanMemory::Entry& entry : read.entries()) memory.remember(entry.workload, entry.choice);
    return "";
  } catch (const nlohmann::json::exception& error) {
    return not_used("it is broken: " + shortened(error.what(), 150));
  } catch (const std::invalid_argument& error) {
    return not_used("it is broken: " + shortened(error.what(), 150));
  }
}

std::string read_plan_memory(const std::string& path, PlanMemory& memory) {
  std::error_code unknown;  // other errors appear when the file is read
  if (!std::filesystem::exists(path, unknown) && !unknown) return "";
  try {
    return parse_plan_memory(sim::read_file(path, most_memory_bytes), path, memory);
  } catch (const sim::FileError& error) {
    return fmt::format("{}; not used", error.what());
  }
}

}  // namespace detp::validate
