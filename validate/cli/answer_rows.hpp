#pragma once

#include <cstddef>
#include <stop_token>
#include <vector>

#include "detp/sim/base/stopped.hpp"
#include "table.hpp"
#include "value_lists.hpp"

namespace detp::cli {

/// One answer among those that a command line asks for.
struct AnswerRow {
  Json inputs;              ///< resolved
  Json answer;              ///< as JSON shows it
  std::vector<Json> cells;  ///< rows of the CSV table, one at least
};

/// What the text's table of several answers shows.
struct TextColumns {
  Columns inputs;   ///< as columns where rows differ, above the table where all are the same
  Columns answers;  ///< always as columns, if any row has them
};

/// Rows of both lists' combinations. Throws std::length_error for more than most_rows.
[[nodiscard]] inline std::size_t rows_in(ValueLists& problems, ValueLists& candidates) {
  require_rows(problems.rows(), candidates.rows());
  return problems.rows() * candidates.rows();
}

/// The answers to all combinations, in order: prepare() makes what the rows of one problem share, answer(shared) one of
/// them. After a stop, those before it; throws sim::Stopped where there is none.
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

/// The answers in the three formats. One alone keeps its own shape in JSON, and its text is the caller's; several are
/// JSON's `rows`, each with inputs and answer, and a table of the text. `expected`: rows asked for; if there are fewer,
/// or the last one says so, the command was stopped.
[[nodiscard]] Result result_of(const std::vector<AnswerRow>& rows, std::size_t expected, const Columns& columns,
                               const TextColumns& text);

}  // namespace detp::cli
