#include "costs_in_use.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "detp/validate/calibration/probe.hpp"
#include "unit_cost_option.hpp"

namespace detp::cli {
namespace {

CostsInUse built_in() {
  return {
      .simd = validate::built_in_unit_costs(Engine::simd),
      .plain = validate::built_in_unit_costs(Engine::plain),
      .origin = "of each operation: built in, measured on another machine; detp calibrate measures those of this one",
      .built_in = true};
}

CostsInUse calibrated(const validate::StoredCalibration& stored) {
  return {.simd = stored.simd,
          .plain = stored.plain,
          .origin = stored.probe
                        ? "of each operation: built in, scaled by a probe of this machine; detp calibrate knows more"
                        : fmt::format("of each operation: of this machine, calibrated {} (median error {:.2g} %)",
                                      stored.date, 100 * stored.left_out_median_error),
          .relative_error = stored.relative_error(),
          .doubt = stored.doubt()};
}

/// The stored calibration, unless it is missing, broken or of another machine.
CostsInUse stored_or_built_in(const CommonOptions& common) {
  if (common.ranks == nullptr) validate::probe_once();  // on several processes, each might find other costs
  std::string why_not;
  const auto stored = validate::stored_calibration(&why_not);
  if (!why_not.empty()) note(common, fmt::format("{}; not used; detp calibrate makes a new one", why_not));
  return stored ? calibrated(*stored) : built_in();
}

}  // namespace

void note_doubt(const CostsInUse& costs, const CommonOptions& common) {
  if (costs.doubt.empty()) return;
  note(common,
       fmt::format(
           "predicted seconds are doubtful, as is the calibration: {}; calibrate again while the machine is quiet",
           costs.doubt));
}

void CostOptions::add_to(CLI::App& command) {
  command.add_option("--costs", costs_, unit_cost_help() + "\ndefault: those of --calibration");
  add_calibration_to(command);
}

void CostOptions::add_calibration_to(CLI::App& command) {
  command.add_option(
      "--calibration", calibration_,
      "unit costs: none (the built-in ones), auto (those that detp calibrate stored, else by a probe of 0.2 s, kept "
      "like them) or a file that it wrote; default: auto");
}

CostsInUse CostOptions::costs(const CommonOptions& common) const {
  if (const auto given = parse_unit_costs(costs_)) {
    CostsInUse as_given{.simd = *given, .plain = *given, .origin = "of each operation, as given, on one thread"};
    as_given.plain.engine = Engine::plain;
    return as_given;
  }
  if (calibration_ == "none") return built_in();
  if (calibration_ == "auto") return stored_or_built_in(common);
  const validate::StoredCalibration stored = validate::read_calibration(calibration_);
  const std::string differs = validate::difference(stored.key, validate::this_machine());
  if (!differs.empty())
    throw std::invalid_argument(fmt::format(
        "{} is of another machine or program: {}; make one here with detp calibrate", calibration_, differs));
  return calibrated(stored);
}

}  // namespace detp::cli
