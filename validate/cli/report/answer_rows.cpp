#include "answer_rows.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "detp/validate/choice/candidate_json.hpp"

namespace detp::cli {
namespace {

/// Replaces invalid UTF-8, which file names may contain.
std::string text_of(const Json& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace); }

/// The value of each input, or the list of its different values if it is not the same in all rows.
Json shared_inputs(const std::vector<AnswerRow>& rows) {
  Json inputs = Json::object();
  if (rows.empty()) return inputs;
  for (const auto& [name, first] : rows.front().inputs.items()) {
    Json values = Json::array();
    std::set<std::string> seen;
    for (const AnswerRow& row : rows)
      if (row.inputs.contains(name) && seen.insert(text_of(row.inputs[name])).second)
        values.push_back(row.inputs[name]);
    inputs[name] = values.size() == 1 ? first : std::move(values);
  }
  return inputs;
}

Json rows_json(const std::vector<AnswerRow>& rows) {
  Json json = Json::array();
  for (const AnswerRow& row : rows) {
    json.push_back({{"inputs", row.inputs}});
    json.back().update(row.answer);
  }
  return json;
}

std::string to_text(const std::vector<AnswerRow>& rows, const TextColumns& columns) {
  std::vector<Json> cells;
  for (const AnswerRow& row : rows) cells.push_back(row.cells.front());
  return aligned_text(cells, columns.inputs, columns.answers, columns.screen) +
         (columns.legend.empty() ? "" : legend(columns.screen, columns.legend));
}

}  // namespace

Result result_of(const std::vector<AnswerRow>& rows, std::size_t expected, const Columns& columns,
                 const TextColumns& text) {
  Result result;
  const bool last_is_partial = rows.back().answer.value("stopped", false);
  const bool stopped = rows.size() < expected || last_is_partial;
  if (stopped) result.stopped = {rows.size() - (last_is_partial ? 1 : 0), expected, "rows"};
  if (expected == 1) {
    result.inputs = rows.front().inputs;
    result.json = rows.front().answer;
  } else {
    result.inputs = shared_inputs(rows);
    result.json = {{"rows", rows_json(rows)}, {"stopped", stopped}};
    result.text = to_text(rows, text);
  }
  Table table(columns);
  for (const AnswerRow& row : rows)
    for (const Json& cells : row.cells) table.add(cells);
  result.csv = table.csv();
  return result;
}

}  // namespace detp::cli
