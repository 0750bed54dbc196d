#include "calibrate_answer.hpp"

#include "calibration_file.hpp"
#include "detp/sim/lists/simd/instruction_sets.hpp"
#include "detp/validate/statistics/statistics.hpp"

namespace detp::validate {
namespace {

std::string joined(const std::vector<std::string_view>& symbols) {
  std::string list;
  for (const std::string_view symbol : symbols) list += (list.empty() ? "" : ", ") + std::string(symbol);
  return list;
}

/// Calls visit(engine, technique, fit) for each fit among `fits`, a member of EngineCalibration.
template <class Fits, class Visit>
void for_each_fit(const Calibration& calibration, Fits EngineCalibration::*fits, const Visit& visit) {
  for (const Engine engine : {Engine::simd, Engine::plain})
    for (const Technique technique : all_techniques)
      if (const auto& fit = (calibration.of(engine).*fits)[static_cast<std::size_t>(technique)])
        visit(engine, technique, *fit);
}

Json rows_json(const std::vector<FitRow>& rows) {
  Json json = Json::array();
  for (const FitRow& row : rows) json.push_back(json_of(fit_fields(), row));
  return json;
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

/// A value of the fit of threads, or nothing.
Field<FitRow> of_threads(const std::string& name, const std::string& meaning, double ThreadCosts::*cost) {
  return Field<FitRow>(
             name, "", meaning,
             [cost](const FitRow& row) { return row.threads != nullptr ? Json(row.threads->costs.*cost) : left_out(); })
      .in_tables_alone();
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

double FitRow::left_out_median_error() const {
  return median(costs != nullptr ? costs->left_out_errors : threads->left_out_errors);
}

std::vector<FitRow> cost_fit_rows(const Calibration& calibration) {
  std::vector<FitRow> rows;
  for_each_fit(calibration, &EngineCalibration::fits, [&](Engine engine, Technique technique, const CostFit& fit) {
    rows.push_back({.technique = technique, .engine = engine, .costs = &fit});
  });
  return rows;
}

std::vector<FitRow> thread_fit_rows(const Calibration& calibration) {
  std::vector<FitRow> rows;
  for_each_fit(calibration, &EngineCalibration::thread_fits,
               [&](Engine engine, Technique technique, const ThreadFit& fit) {
                 rows.push_back({.technique = technique, .engine = engine, .threads = &fit});
               });
  return rows;
}

const Fields<CalibrateAnswer>& calibrate_fields() {
  using Answer = CalibrateAnswer;
  static const Fields<Answer> fields{
      stored("costs", "s", "the unit costs of each engine and technique, by their symbols"),
      stored("threads", "", "the costs of threads of each engine and technique: serial shares, and seconds of a start"),
      {"fits", "", "the fits of the unit costs",
       [](const Answer& a) { return rows_json(cost_fit_rows(a.calibration)); }},
      {"thread_fits", "", "the fits of the costs of threads",
       [](const Answer& a) { return rows_json(thread_fit_rows(a.calibration)); }},
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

const Fields<FitRow>& fit_fields() {
  static const Fields<FitRow> fields{
      {"technique", "", "whose costs they are", [](const FitRow& row) { return name(row.technique); }},
      {"engine", "", "that ran it", [](const FitRow& row) { return name(row.engine); }},
      Field<FitRow>("symbol", "", "of the unit cost; thread: the start of each further thread",
                    [](const FitRow& row) { return row.term != nullptr ? row.term->symbol : "thread"; })
          .in_tables_alone(),
      Field<FitRow>("seconds", "s", "the cost",
                    [](const FitRow& row) {
                      return row.term != nullptr ? row.costs->costs.*row.term->cost : row.threads->costs.start;
                    })
          .in_tables_alone(),
      of_threads("serial_preparing", "share of sorting and building that one thread does",
                 &ThreadCosts::serial_preparing),
      of_threads("serial_search", "share of the search that one thread does", &ThreadCosts::serial_search),
      {"runs", "", "number that were fitted", &FitRow::runs},
      {"median_error", "", "of the seconds of these runs, relative", &FitRow::median_error},
      {"left_out_median_error", "", "the same by fits without the run", &FitRow::left_out_median_error},
      {"condition", "", "number of the fit's matrix",
       [](const FitRow& row) { return row.costs != nullptr ? Json(row.costs->condition) : left_out(); }},
      Field<FitRow>(
          "fitted", "", "symbols of the costs above 0",
          [](const FitRow& row) { return row.costs != nullptr ? Json(joined(row.costs->fitted)) : left_out(); })
          .in_json_alone(),
      Field<FitRow>(
          "dropped", "", "symbols of the costs that the runs could not tell apart from others",
          [](const FitRow& row) { return row.costs != nullptr ? Json(joined(row.costs->dropped)) : left_out(); })
          .in_json_alone()};
  return fields;
}

std::vector<Json> calibrate_rows(const Calibration& calibration) {
  std::vector<Json> rows;
  for (FitRow row : cost_fit_rows(calibration))
    for (const UnitCostTerm& term : unit_cost_terms) {
      row.term = &term;
      if (row.costs->costs.*term.cost > 0) rows.push_back(cells_of(fit_fields(), row));
    }
  for (const FitRow& row : thread_fit_rows(calibration)) rows.push_back(cells_of(fit_fields(), row));
  return rows;
}

std::vector<FieldText> describe_calibrate() {
  return describe_fields(calibrate_fields()) + describe_fields(fit_fields());
}

}  // namespace detp::validate
