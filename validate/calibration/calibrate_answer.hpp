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
  Calibration calibration;
  Json stored;                         ///< calibration_json()
  std::string saved = {};              ///< the path; empty: not saved
  std::string not_saved_because = {};  ///< empty if it was saved
  bool could_be_saved = false;         ///< not saved because of the file that is there: to another one it could be
};

/// Throws std::invalid_argument for seconds that are not positive and an instruction set that this machine lacks, and sim::FileError if the
/// file cannot be written. No other search may run meanwhile if an instruction set is named.
[[nodiscard]] CalibrateAnswer answer(const CalibrateRequest& request, const std::stop_token& stop = {},
                                     const sim::ReportPhase& progress = {});

/// A fit of one technique by one engine: of its costs on one thread, or of those of threads.
struct FitRow {
  Technique technique;
  Engine engine;
  const CostFit* costs = nullptr;
  const ThreadFit* threads = nullptr;
  const UnitCostTerm* term = nullptr;  ///< the cost of a row of a table

  [[nodiscard]] std::size_t runs() const { return costs != nullptr ? costs->runs : threads->runs; }
  [[nodiscard]] double median_error() const { return costs != nullptr ? costs->median_error : threads->median_error; }
  [[nodiscard]] double left_out_median_error() const;
};

/// The fits of costs on one thread, or those of costs of threads. They refer to the calibration.
[[nodiscard]] std::vector<FitRow> cost_fit_rows(const Calibration& calibration);
[[nodiscard]] std::vector<FitRow> thread_fit_rows(const Calibration& calibration);

[[nodiscard]] const Fields<CalibrateAnswer>& calibrate_fields();
[[nodiscard]] const Fields<FitRow>& fit_fields();

/// The rows of the table, with the columns of fit_fields(): one for each cost above 0, and one for each fit of costs of threads.
[[nodiscard]] std::vector<Json> calibrate_rows(const Calibration& calibration);

/// Of calibrate_fields() and fit_fields().
[[nodiscard]] std::vector<FieldText> describe_calibrate();

}  // namespace detp::validate
