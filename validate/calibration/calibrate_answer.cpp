#include "calibrate_answer.hpp"

#include "calibration_file.hpp"
#include "detp/sim/lists/simd/instruction_sets.hpp"

namespace detp::validate {
namespace {

std::string joined(const std::vector<std::string_view>& symbols) {
  std::string list;
  for (const std::string_view symbol : symbols) list += (list.empty() ? "" : ", ") + std::string(symbol);
  return list;
}

/// A fit of costs on one thread, or of those of threads.
struct FitRow {
  explicit FitRow(const CostFit& of, const UnitCostTerm* of_term = nullptr) : fit(of), costs(&of), term(of_term) {}
  explicit FitRow(const ThreadFit& of) : fit(of), threads(&of) {}

  const FitQuality& fit;
  const CostFit* costs = nullptr;
  const ThreadFit* threads = nullptr;
  const UnitCostTerm* term = nullptr;  ///< the cost of a row of the table
};

template <class Fit>
std::vector<FitRow> rows_of(const std::vector<Fit>& fits) {
  return {fits.begin(), fits.end()};
}

/// A field of fits of costs on one thread, or of those of threads.
template <class Value>
Field<FitRow> of_costs(const char* name, const char* meaning, Value value) {
  return {name, "", meaning,
          [value](const FitRow& row) { return row.costs != nullptr ? Json(value(*row.costs)) : left_out(); }};
}
Field<FitRow> of_threads(const char* name, const char* meaning, double ThreadCosts::*cost) {
  return {name, "", meaning,
          [cost](const FitRow& row) { return row.threads != nullptr ? Json(row.threads->costs.*cost) : left_out(); }};
}

const Fields<FitRow>& fit_fields() {
  static const Fields<FitRow> fields{
      {"technique", "", "whose costs they are", [](const FitRow& row) { return name(row.fit.technique); }},
      {"engine", "", "that ran it", [](const FitRow& row) { return name(row.fit.engine); }},
      Field<FitRow>("symbol", "", "of the unit cost; thread: the start of each further thread",
                    [](const FitRow& row) { return row.term != nullptr ? row.term->symbol : "thread"; })
          .in_tables_alone(),
      Field<FitRow>("seconds", "s", "the cost",
                    [](const FitRow& row) {
                      return row.term != nullptr ? row.costs->costs.*row.term->cost : row.threads->costs.start;
                    })
          .in_tables_alone(),
      of_threads("serial_preparing", "share of sorting and building that one thread does",
                 &ThreadCosts::serial_preparing)
          .in_tables_alone(),
      of_threads("serial_search", "share of the search that one thread does", &ThreadCosts::serial_search)
          .in_tables_alone(),
      {"runs", "", "number that were fitted", [](const FitRow& row) { return row.fit.runs; }},
      {"median_error", "", "of the seconds of these runs, relative",
       [](const FitRow& row) { return row.fit.median_error; }},
      {"left_out_median_error", "", "the same by fits without the run",
       [](const FitRow& row) { return row.fit.left_out_median_error(); }},
      of_costs("condition", "number of the fit's matrix", [](const CostFit& fit) { return fit.condition; }),
      of_costs("fitted", "symbols of the costs above 0", [](const CostFit& fit) { return joined(fit.fitted); })
          .in_json_alone(),
      of_costs("dropped", "symbols of the costs that the runs could not tell apart from others",
               [](const CostFit& fit) { return joined(fit.dropped); })
          .in_json_alone()};
  return fields;
}

void save(const CalibrateRequest& request, CalibrateAnswer& answer) {
  const std::string path = request.output.value_or(default_calibration_path());
  if (answer.calibration.stopped) {
    answer.not_saved_because = "stopped";
  } else if (request.output) {
    write_calibration(path, answer.calibration);
  } else if (path.empty()) {
    answer.not_saved_because = "there is no folder for it";
  } else {
    answer.not_saved_because = save_calibration(path, answer.calibration);
    answer.could_be_saved = !answer.not_saved_because.empty();
  }
  if (answer.not_saved_because.empty()) answer.saved = path;
}

/// A member of what is stored.
Field<CalibrateAnswer> stored(const std::string& name, const std::string& unit, const std::string& meaning) {
  return {name, unit, meaning, [name](const CalibrateAnswer& answer) { return answer.stored.at(name); }};
}

}  // namespace

CalibrateAnswer answer(const CalibrateRequest& request, const std::stop_token& stop, const sim::ReportPhase& progress) {
  require_positive("seconds", request.seconds);
  std::optional<sim::stream::OnlyInstructionSet> only;
  if (!request.instruction_set.empty()) only.emplace(request.instruction_set);
  CalibrateAnswer answer{
      .calibration =
          calibrate({.seconds = request.seconds, .threads = request.threads, .stop = stop, .progress = progress}),
      .stored = {}};
  answer.stored = calibration_json(answer.calibration);
  save(request, answer);
  return answer;
}

const Fields<CalibrateAnswer>& calibrate_fields() {
  using Answer = CalibrateAnswer;
  static const Fields<Answer> fields{
      stored("costs", "s", "the unit costs of each engine and technique, by their symbols"),
      stored("threads", "", "the costs of threads of each engine and technique: serial shares, and seconds of a start"),
      {"fits", "", "the fits of the unit costs",
       [](const Answer& a) { return rows_json(fit_fields(), rows_of(a.calibration.fits)); }},
      {"thread_fits", "", "the fits of the costs of threads",
       [](const Answer& a) { return rows_json(fit_fields(), rows_of(a.calibration.thread_fits)); }},
      {"left_out_median_error", "", "median relative error of runs on one thread, by fits without them",
       [](const Answer& a) { return a.calibration.left_out_median_error; }},
      {"threads_left_out_median_error", "", "the same of runs on more threads, from their times on one",
       [](const Answer& a) { return a.calibration.threads_left_out_median_error; }},
      {"relative_error", "", "standard error of seconds by these costs, relative to them",
       [](const Answer& a) { return a.calibration.relative_error(); }},
      stored("relative_errors", "", "the same of each engine and technique"),
      {"doubtful", "", "whether predictions by these costs are doubtful",
       [](const Answer& a) { return !a.calibration.doubt().empty(); }},
      {"workloads", "", "number measured", [](const Answer& a) { return a.calibration.workloads; }},
      {"seconds", "s", "that the calibration took", [](const Answer& a) { return a.calibration.seconds; }},
      {"processor_share", "", "processor time over wall time of the runs; other programs took the rest",
       [](const Answer& a) { return a.calibration.processor_share; }},
      stored("key", "", "the machine and program to which the costs belong"),
      stored("date", "", "of the calibration"),
      stored("checksum", "", "of the members that the calibration's file has"),
      {"saved", "", "the file; empty if it was not saved", &Answer::saved}};
  return fields;
}

Columns calibrate_columns() { return columns_of(fit_fields()); }

std::vector<Json> calibrate_rows(const MeasuredCalibration& calibration) {
  std::vector<Json> rows;
  for (const CostFit& fit : calibration.fits)
    for (const UnitCostTerm& term : unit_cost_terms)
      if (fit.costs.*term.cost > 0) rows.push_back(cells_of(fit_fields(), FitRow(fit, &term)));
  for (const ThreadFit& fit : calibration.thread_fits) rows.push_back(cells_of(fit_fields(), FitRow(fit)));
  return rows;
}

std::vector<FieldText> describe_calibrate() {
  return describe_fields(calibrate_fields()) + describe_fields(fit_fields());
}

}  // namespace detp::validate
