#include "calibration_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>

#include "built_in_costs.hpp"

namespace detp::validate {
namespace {

/// Whether a file can be made there. Makes its folder.
bool can_write(const std::string& path) {
  if (path.empty()) return false;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  return !failed && access(folder.c_str(), W_OK) == 0;
}

CostsInUse built_in_costs() {
  return {
      .simd = built_in_unit_costs(Engine::simd),
      .plain = built_in_unit_costs(Engine::plain),
      .origin = "of each operation: built in, measured on another machine; detp calibrate measures those of this one",
      .built_in = true};
}

CostsInUse calibrated_costs(const Calibration& stored) {
  return {.simd = stored.simd,
          .plain = stored.plain,
          .origin = stored.probe
                        ? "of each operation: built in, scaled by a probe of this machine; detp calibrate knows more"
                        : fmt::format("of each operation: of this machine, calibrated {} (median error {:.2g} %)",
                                      stored.date, 100 * stored.left_out_median_error),
          .relative_error = stored.relative_error(),
          .doubt = stored.doubt()};
}

}  // namespace

void probe_once(const std::stop_token& stop) {
  const std::string path = probe_path();
  if (stored_calibration() || !can_write(path)) return;
  try {
    const Calibration found = probe(stop);
    if (!stop.stop_requested()) write_calibration(path, found);
  } catch (const std::exception&) {  // no memory, or a full disk: no reason to refuse what was asked
  }
}

CostsInUse costs_in_use(const CostRequest& request, const Notice& notice) {
  if (request.given) {
    CostsInUse as_given{
        .simd = *request.given, .plain = *request.given, .origin = "of each operation, as given, on one thread"};
    as_given.plain.engine = Engine::plain;
    return as_given;
  }
  if (request.calibration == "none") return built_in_costs();
  if (request.calibration != "auto") {
    const Calibration stored = read_calibration(request.calibration);
    const std::string differs = difference(stored.key, this_machine());
    if (!differs.empty())
      throw std::invalid_argument(fmt::format(
          "{} is of another machine or program: {}; make one here with detp calibrate", request.calibration, differs));
    return calibrated_costs(stored);
  }
  if (request.may_probe) probe_once();
  std::string why_not;
  const auto stored = stored_calibration(&why_not);
  if (notice && !why_not.empty()) notice(fmt::format("{}; not used; detp calibrate makes a new one", why_not));
  return stored ? calibrated_costs(*stored) : built_in_costs();
}

nlohmann::ordered_json to_json(const UnitCosts& costs) {
  nlohmann::ordered_json json;
  for (const UnitCostTerm& one : unit_cost_terms) json[std::string(one.symbol)] = costs.*one.cost;
  return json;
}

nlohmann::ordered_json to_json(const CostTable& costs) {
  if (costs.of_technique == CostTable(costs.of_technique.front()).of_technique)
    return to_json(costs.of_technique.front());
  nlohmann::ordered_json json;
  for (const Technique technique : exact_techniques) {
    nlohmann::ordered_json& of_one = json[std::string(name(technique))] = nlohmann::ordered_json::object();
    for (const UnitCostTerm& one : unit_cost_terms)
      if (const double cost = costs[technique].*one.cost; cost > 0) of_one[std::string(one.symbol)] = cost;
  }
  return json;
}

}  // namespace detp::validate
