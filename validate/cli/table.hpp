#pragma once

#include <string>
#include <vector>

#include "command.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"

/// Answers as one tidy table: a row each, the columns declared once.
namespace detp::cli {

using Columns = std::vector<std::string>;

[[nodiscard]] Columns operator+(Columns left, const Columns& right);

/// Rows of numbers, strings and booleans under declared columns. What a row does not name, null, and numbers that are
/// not finite are empty fields.
class Table {
 public:
  explicit Table(Columns columns) : columns_(std::move(columns)) {}

  /// Appends a row: a flat JSON object. Throws std::logic_error for a name that is no column and for a nested value.
  void add(const Json& row);

  /// RFC 4180, with \n at the end of a line: a header, then the rows. Numbers in the shortest form that reads back to
  /// the same double.
  [[nodiscard]] std::string csv() const;

 private:
  Columns columns_;
  std::vector<std::vector<Json>> rows_;
};

/// Rows for a reader: above, each input that all rows share; below, aligned, the inputs that differ and the answers.
[[nodiscard]] std::string aligned_text(const std::vector<Json>& rows, const Columns& inputs, const Columns& answers);

/// Columns that every table begins with: which rays and discs.
[[nodiscard]] const Columns& workload_columns();

/// `technique`, `parameters` as a reader's text, and one column for each parameter of any technique.
[[nodiscard]] const Columns& candidate_columns();

/// One column for each term of Counts, and `tests`, each after the prefix ("predicted_").
[[nodiscard]] Columns count_columns(const std::string& prefix = "");

/// Those of effect_cells().
[[nodiscard]] const Columns& effect_columns();

/// A list of texts as one cell: "; " between them.
[[nodiscard]] std::string joined(const std::vector<std::string>& texts);

/// The workload's columns, from the resolved inputs of a command.
[[nodiscard]] Json workload_cells(const Json& inputs);

[[nodiscard]] Json candidate_cells(const Candidate& candidate);

template <class T>
[[nodiscard]] Json count_cells(const Counts<T>& counts, const std::string& prefix = "") {
  Json cells;
  for_each_term(counts, [&](std::string_view term, T value) { cells[prefix + std::string(term)] = value; });
  cells[prefix + "tests"] = tests(counts);
  return cells;
}

/// The same of counts in JSON.
[[nodiscard]] Json count_cells(const Json& counts);

}  // namespace detp::cli
