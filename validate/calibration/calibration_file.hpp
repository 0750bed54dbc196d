#pragma once

#include <string>

#include "calibrate.hpp"
#include "calibration_key.hpp"

/// Calibrations on disc.
namespace detp::validate {

struct StoredCalibration {
  CalibrationKey key;
  std::string date;  ///< "2026-11-20"
  CostTable plain;
  CostTable simd;
  double left_out_median_error = 0;
};

/// detp/calibration.json in $XDG_CACHE_HOME, or in ~/.cache if that is not set to an absolute path; empty if there is
/// no home either.
[[nodiscard]] std::string default_calibration_path();

/// The content of a calibration's file: JSON with the key of this machine and today's date.
[[nodiscard]] std::string calibration_text(const Calibration& calibration);

/// Writes the file, and its folder if necessary. Throws sim::FileError.
void write_calibration(const std::string& path, const Calibration& calibration);

/// Throws sim::FileError if the file cannot be read, if it is not a calibration, or if an older or newer program wrote it.
[[nodiscard]] StoredCalibration read_calibration(const std::string& path);

/// The text as read_calibration reads it; `path` is for messages.
[[nodiscard]] StoredCalibration parse_calibration(const std::string& text, const std::string& path);

}  // namespace detp::validate
