#pragma once

#include <optional>
#include <string>

#include "calibrate.hpp"

/// Calibrations on disc.
namespace detp::validate {

struct StoredCalibration : CalibrationQuality {
  CalibrationKey key;
  std::string date;  ///< "2026-11-20"
  CostTable plain;
  CostTable simd;

  [[nodiscard]] const CostTable& of(Engine engine) const { return engine == Engine::plain ? plain : simd; }
};

/// detp/calibration.json in $XDG_CACHE_HOME, or in ~/.cache if that is not set to an absolute path; empty if there is
/// no home either.
[[nodiscard]] std::string default_calibration_path();

/// detp/probe.json beside it.
[[nodiscard]] std::string probe_path();

/// The content of a calibration's file: the key of this machine, today's date, the costs and their errors, a checksum.
[[nodiscard]] nlohmann::ordered_json calibration_json(const Calibration& calibration);
[[nodiscard]] std::string calibration_text(const Calibration& calibration);

/// Writes the file, and its folder if necessary. Throws sim::FileError.
void write_calibration(const std::string& path, const Calibration& calibration);

/// The same, but a doubtful calibration does not replace a better one of this machine and program, and none replaces another
/// program's file. Returns why it was not written; "" if it was.
std::string save_calibration(const std::string& path, const Calibration& calibration);

/// Throws sim::FileError if the file cannot be read, if it is not a calibration, or if an older or newer program wrote it.
[[nodiscard]] StoredCalibration read_calibration(const std::string& path);

/// The calibration in the file, if there is one of this machine and program. Else nullopt, and in *why_not, unless null, the
/// reason with the path; "" if there is no such file.
[[nodiscard]] std::optional<StoredCalibration> find_calibration(const std::string& path,
                                                                std::string* why_not = nullptr);

/// The one that detp calibrate stored, else the one of a probe (probe_once); `why_not` is that of the first.
[[nodiscard]] std::optional<StoredCalibration> stored_calibration(std::string* why_not = nullptr);

/// The stored costs of this machine, for PlanOptions::costs; the built-in ones if there are none that can be used.
[[nodiscard]] CostTable stored_unit_costs(Engine engine = Engine::simd);

/// The text as read_calibration reads it; `path` is for messages.
[[nodiscard]] StoredCalibration parse_calibration(const std::string& text, const std::string& path);

}  // namespace detp::validate
