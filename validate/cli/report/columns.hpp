#pragma once

#include <string>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/validate/cli/text/table.hpp"

/// Columns that the tables of several commands have, and their cells.
namespace detp::cli {

/// The first columns of every table: rays and discs.
[[nodiscard]] const Columns& workload_columns();

/// `technique`, `parameters` as text, and one column for each parameter of any technique.
[[nodiscard]] const Columns& candidate_columns();

/// One column for each term of Counts, and `tests`, each after the prefix ("predicted_").
[[nodiscard]] Columns count_columns(const std::string& prefix = "");

/// The cells of the workload's columns, from a command's resolved inputs.
[[nodiscard]] Json workload_cells(const Json& inputs);

[[nodiscard]] Json candidate_cells(const Candidate& candidate);

template <class T>
[[nodiscard]] Json count_cells(const Counts<T>& counts, const std::string& prefix = "") {
  Json cells;
  for_each_term(counts, [&](std::string_view term, T value) { cells[prefix + std::string(term)] = value; });
  cells[prefix + "tests"] = tests(counts);
  return cells;
}

/// The cells of the columns of counts, from counts in JSON.
[[nodiscard]] Json count_cells(const Json& counts);

}  // namespace detp::cli
