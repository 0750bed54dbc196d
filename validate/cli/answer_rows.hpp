#pragma once

#include <cstddef>
#include <stop_token>
#include <vector>

#include "detp/sim/base/stopped.hpp"
#include "table.hpp"
#include "value_lists.hpp"

namespace detp::cli {

/// One result of a command line that asks for several.
struct AnswerRow {
  Json inputs;              ///< resolved inputs
  Json answer;              ///< as in JSON
  std::vector<Json> cells;  ///< rows of the CSV table, at least one
};

/// The columns of the text table of several results.
struct TextColumns {
  Columns inputs;   ///< as columns if rows differ; above the table if all are the same
  Columns answers;  ///< always as columns, if any row has them
  Screen screen;
};

/// Number of rows for all combinations of both lists. Throws std::length_error for more than most_rows.
[[nodiscard]] inline std::size_t rows_in(ValueLists& problems, ValueLists& candidates) {
  require_rows(problems.rows(), candidates.rows());
  return problems.rows() * candidates.rows();
}

/// The results for all combinations, in order. prepare() makes the data that the rows of one problem share;
/// answer(shared) makes the result of one row. After a stop request, returns the rows before it; throws sim::Stopped if
/// there is none.
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

/// The results in the three formats. A single one keeps its own form in JSON, and its text is the caller's; several are
/// `rows` in JSON, each with inputs and answer, and a table in the text. `expected`: number of rows requested. If there
/// are fewer, or the last one is marked as stopped, the command was stopped.
[[nodiscard]] Result result_of(const std::vector<AnswerRow>& rows, std::size_t expected, const Columns& columns,
                               const TextColumns& text);

}  // namespace detp::cli
