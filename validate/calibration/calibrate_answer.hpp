#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "calibrate.hpp"
#include "detp/validate/base/fields.hpp"

/// Measures the unit costs of this machine, and saves them for later questions: `detp calibrate`.
namespace detp::validate {

struct CalibrateRequest {
  double seconds = CalibrationOptions{}.seconds;
  int threads = 0;                   ///< as CalibrationOptions::threads
  std::string instruction_set = {};  ///< the only one of the kernels; empty: all that the machine has
  std::optional<std::string> output =
      {};  ///< the file, whatever it has; none: where later questions look, unless a better one is there
};

struct CalibrateAnswer {
  MeasuredCalibration calibration;
  Json stored;                         ///< calibration_json()
  std::string saved = {};              ///< the path; empty: not saved
  std::string not_saved_because = {};  ///< empty if it was saved
  bool could_be_saved = false;         ///< not saved because of the file that is there: to another one it could be
};

/// Throws std::invalid_argument for seconds that are not positive and an instruction set that this machine lacks, and sim::FileError if the
/// file cannot be written. No other search may run meanwhile if an instruction set is named.
[[nodiscard]] CalibrateAnswer answer(const CalibrateRequest& request, const std::stop_token& stop = {},
                                     const sim::ReportPhase& progress = {});

[[nodiscard]] const Fields<CalibrateAnswer>& calibrate_fields();

/// The table: a row for each cost above 0 of each fit, and one for each fit of costs of threads.
[[nodiscard]] Columns calibrate_columns();
[[nodiscard]] std::vector<Json> calibrate_rows(const MeasuredCalibration& calibration);

/// Of the answer and of its fits.
[[nodiscard]] std::vector<FieldText> describe_calibrate();

}  // namespace detp::validate
