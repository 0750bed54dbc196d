#pragma once

#include <cstddef>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/phase.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/validate/answer/parts.hpp"
#include "detp/validate/cli/options/value_lists.hpp"
#include "detp/validate/cli/text/table.hpp"

/// Rows of answers, one for each combination of option values.
namespace detp::cli {

using validate::candidate_cells;
using validate::candidate_columns;
using validate::count_cells;
using validate::count_columns;
using validate::workload_cells;
using validate::workload_columns;

/// The result for one combination of option values.
struct AnswerRow {
  Json inputs;              ///< resolved inputs
  Json answer;              ///< the content of the JSON output
  std::vector<Json> cells;  ///< the row or rows of the CSV table
};

struct TextColumns {
  Columns inputs;   ///< inputs that differ between rows are columns; all other inputs are printed above the table
  Columns answers;  ///< always columns, if any row has them
  Screen screen;
  std::string legend = {};  ///< below the table
};

/// Divides the progress among the rows of a table: for each problem first that of making it, then that of its candidates.
class RowProgress {
 public:
  /// `work` of each problem with all of its candidates, in any unit.
  RowProgress(const std::vector<double>& work, std::size_t candidates) : candidates_(candidates) {
    for (const double one : work) ends_.push_back((ends_.empty() ? 0 : ends_.back()) + one);
  }

  sim::ReportPhase job(sim::ReportPhase whole) {
    const double begin = row_ < candidates_ ? 0 : ends_[row_ / candidates_ - 1];
    after_job_ = begin + (ends_[row_ / candidates_] - begin) * share_of_job;
    return sim::part_of(std::move(whole), begin / ends_.back(), after_job_ / ends_.back());
  }
  sim::ReportPhase next(sim::ReportPhase whole) {
    const double each = (ends_[row_ / candidates_] - after_job_) / static_cast<double>(candidates_);
    const double begin = after_job_ + each * static_cast<double>(row_++ % candidates_);
    return sim::part_of(std::move(whole), begin / ends_.back(), (begin + each) / ends_.back());
  }

 private:
  static constexpr double share_of_job = 0.3;

  std::size_t candidates_;
  std::vector<double> ends_;  ///< of each problem: the sum of the work up to its end
  std::size_t row_ = 0;
  double after_job_ = 0;
};

/// Number of rows for all combinations of both lists. Throws std::length_error for more than most_rows.
[[nodiscard]] inline std::size_t rows_in(ValueLists& problems, ValueLists& candidates) {
  require_rows(problems.rows(), candidates.rows());
  return problems.rows() * candidates.rows();
}

/// The results for all combinations, in order. prepare() returns the data that the rows of one problem share.
/// answer(shared) returns the result of one row. After a stop request, returns the rows so far, of which the last may
/// be partial, or throws sim::Stopped if there is none.
template <class Prepare, class Answer>
[[nodiscard]] std::vector<AnswerRow> answer_all(ValueLists& problems, ValueLists& candidates,
                                                const std::stop_token& stop, Prepare prepare, Answer answer) {
  std::vector<AnswerRow> rows;
  const std::size_t of_one_problem = candidates.rows();
  try {
    for (std::size_t i = 0; i < problems.rows(); ++i) {
      problems.choose_row(i);
      const auto shared = prepare();
      for (std::size_t j = 0; j < of_one_problem; ++j) {
        if (!rows.empty() && stop.stop_requested()) return rows;
        candidates.choose_row(j);
        rows.push_back(answer(shared));
      }
    }
  } catch (const sim::Stopped&) {
    if (rows.empty()) throw;
  }
  return rows;
}

/// The results in the three formats. Several rows are an array `rows` in JSON, each with inputs and answer, and a table
/// in the text. A single row is not put in an array, and the caller writes its text. `expected` is the number of rows
/// requested. The result is marked as stopped if `rows` has fewer rows, or if its last row is marked as stopped.
[[nodiscard]] Result result_of(const std::vector<AnswerRow>& rows, std::size_t expected, const Columns& columns,
                               const TextColumns& text);

}  // namespace detp::cli
