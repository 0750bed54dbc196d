#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cctype>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "csv_answer.hpp"
#include "detp/validate/statistics/statistics.hpp"

/// Figures of pages that are recomputed from notebooks-data.
///
/// A marker in front of a table says what the table's figures are. It is an HTML comment, so readers do not see it:
///
///     <!-- figures FILE where CONDITIONS
///     columns ; STATISTICS ; STATISTICS …
///     rows CONDITIONS ; CONDITIONS …
///     -->
///
/// The n-th entry of `columns` belongs to the n-th column of the table, the n-th entry of all lines `rows` to its n-th row below the header.
/// Words of an entry of `columns` that begin with @ are conditions of this column alone: `@CONDITION`. A cell has the
/// figures of its statistics in their order; other text, and columns with an empty entry, are free. A marker in a sentence has
/// the figures that follow it:
///
///     <!-- figures FILE where CONDITIONS: STATISTICS -->
///
/// A marker behind a backquote is an example, and is skipped.
///
/// CONDITIONS, separated by blanks, must all hold: COLUMN=TEXT, COLUMN!=TEXT, or COLUMN<NUMBER with <, <=, > or >=.
/// STATISTICS, separated by blanks:
///
///     count                        number of rows
///     share(CONDITION)             share of the rows, of 1
///     median(COLUMN)               also min, max, and mean
///     p05(COLUMN)                  a percentile
///     geomean(COLUMN)              geometric mean
///     low(COLUMN,GROUP)            lower end of the 95 % interval of the geometric mean over groups of rows, each the geometric
///     high(COLUMN,GROUP)           mean of its rows: Student's t of the groups' logarithms. Also the upper end
///
/// A statistic may be followed by -1, which is subtracted. A figure that "%" follows is multiplied by 100. The figure must be the
/// statistic, rounded to as many decimals as the page shows.
namespace detp::support {

/// One figure of a page and the data that it should show.
struct Figure {
  std::string statistic;  ///< with file and conditions
  std::string shown;
  std::string computed;  ///< with as many decimals as `shown`
};

using Rows = std::vector<CsvRow>;

namespace figures {

[[noreturn]] inline void refuse(const std::string& what) { throw std::invalid_argument(what); }

inline const std::string& field(const CsvRow& row, const std::string& column) {
  const auto found = row.find(column);
  if (found == row.end()) refuse(fmt::format("there is no column {}", column));
  return found->second;
}

inline double value(const CsvRow& row, const std::string& column) {
  const std::string& text = field(row, column);
  std::size_t end = 0;
  double number = 0;
  try {
    number = std::stod(text, &end);
  } catch (const std::exception&) {
  }
  if (text.empty() || end != text.size()) refuse(fmt::format("column {} has no number but \"{}\"", column, text));
  return number;
}

inline bool holds(const CsvRow& row, const std::string& condition) {
  for (const std::string sign : {"!=", "<=", ">=", "=", "<", ">"}) {
    const std::size_t at = condition.find(sign);
    if (at == std::string::npos) continue;
    const std::string column = condition.substr(0, at);
    const std::string wanted = condition.substr(at + sign.size());
    if (sign == "=") return field(row, column) == wanted;
    if (sign == "!=") return field(row, column) != wanted;
    const double found = value(row, column);
    const double limit = std::stod(wanted);
    return sign == "<=" ? found <= limit : sign == ">=" ? found >= limit : sign == "<" ? found < limit : found > limit;
  }
  refuse(fmt::format("not a condition: {}", condition));
}

inline Rows selected(Rows rows, const std::vector<std::string>& conditions) {
  std::erase_if(rows, [&](const CsvRow& row) {
    return !std::ranges::all_of(conditions, [&](const std::string& one) { return holds(row, one); });
  });
  return rows;
}

inline std::vector<double> values(const Rows& rows, const std::string& column) {
  std::vector<double> all;
  for (const CsvRow& row : rows) all.push_back(value(row, column));
  return all;
}

inline double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

inline std::vector<double> logarithms(std::vector<double> values) {
  for (double& value : values) value = std::log(value);
  return values;
}

/// An end of the interval; `side` is -1 or 1.
inline double interval_end(const Rows& rows, const std::string& column, const std::string& group, int side) {
  std::map<std::string, Rows> groups;
  for (const CsvRow& row : rows) groups[field(row, group)].push_back(row);
  if (groups.size() < 2) refuse("an interval needs two groups");
  std::vector<double> means;
  for (const auto& [name, members] : groups) means.push_back(mean(logarithms(values(members, column))));
  const double centre = mean(means);
  double squares = 0;
  for (const double one : means) squares += (one - centre) * (one - centre);
  const auto count = static_cast<double>(means.size());
  const double t = quantile(boost::math::students_t(count - 1), 0.975);
  return std::exp(centre + side * t * std::sqrt(squares / (count - 1) / count));
}

inline double plain_statistic(const Rows& rows, const std::string& text) {
  if (rows.empty()) refuse("no row meets the conditions");
  if (text == "count") return static_cast<double>(rows.size());
  const std::size_t open = text.find('(');
  if (open == std::string::npos || text.back() != ')') refuse(fmt::format("not a statistic: {}", text));
  const std::string name = text.substr(0, open);
  const std::string argument = text.substr(open + 1, text.size() - open - 2);
  if (name == "share") return static_cast<double>(selected(rows, {argument}).size()) / static_cast<double>(rows.size());
  if (name == "low" || name == "high") {
    const std::size_t comma = argument.find(',');
    if (comma == std::string::npos) refuse(fmt::format("{} needs a column and a group", name));
    return interval_end(rows, argument.substr(0, comma), argument.substr(comma + 1), name == "low" ? -1 : 1);
  }
  const std::vector<double> all = values(rows, argument);
  if (name == "median") return validate::median(all);
  if (name == "min") return *std::ranges::min_element(all);
  if (name == "max") return *std::ranges::max_element(all);
  if (name == "mean") return mean(all);
  if (name == "geomean") return std::exp(mean(logarithms(all)));
  if (name.size() == 3 && name[0] == 'p') return validate::quantile(all, std::stod(name.substr(1)) / 100);
  refuse(fmt::format("not a statistic: {}", text));
}

inline double statistic(const Rows& rows, const std::string& text) {
  if (text.ends_with("-1")) return plain_statistic(rows, text.substr(0, text.size() - 2)) - 1;
  return plain_statistic(rows, text);
}

inline std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
  return parts;
}

inline std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// A number of the text from `at` on, and whether "%" follows; moves `at` behind it. Empty if there is none.
struct Shown {
  std::string number;
  bool percent = false;
};
inline Shown next_number(const std::string& text, std::size_t& at) {
  const auto digit = [&](std::size_t i) {
    return i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])) != 0;
  };
  while (at < text.size() && !digit(at)) ++at;
  Shown shown;
  const std::size_t begin = at;
  while (digit(at) || (at < text.size() && text[at] == '.' && digit(at + 1))) ++at;
  shown.number = text.substr(begin, at - begin);
  if (begin > 0 && text[begin - 1] == '-') shown.number = "-" + shown.number;
  shown.percent = text.compare(at, 1, "%") == 0 || text.compare(at, 2, " %") == 0;
  return shown;
}

inline void add_figures(const std::string& where, const std::vector<std::string>& statistics, const Rows& rows,
                        const std::string& text, std::vector<Figure>& all) {
  std::size_t at = 0;
  for (const std::string& one : statistics) {
    const Shown shown = next_number(text, at);
    const std::string what = fmt::format("{}: {}", where, one);
    if (shown.number.empty()) refuse(fmt::format("{}: no figure in \"{}\"", what, text));
    const std::size_t dot = shown.number.find('.');
    const std::size_t decimals = dot == std::string::npos ? 0 : shown.number.size() - dot - 1;
    try {
      const double value = statistic(rows, one) * (shown.percent ? 100 : 1);
      all.push_back({what, shown.number, fmt::format("{:.{}f}", value, decimals)});
    } catch (const std::invalid_argument& error) {
      refuse(fmt::format("{}: {}", what, error.what()));
    }
  }
}

/// The cells of a table's line.
inline std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells = split(line, '|');
  if (!cells.empty()) cells.erase(cells.begin());
  return cells;
}

/// Figures of the table that begins `text`. `lines` are those of the marker.
inline void add_table(const std::string& where, const std::vector<std::string>& lines, const Rows& rows,
                      const std::string& text, std::vector<Figure>& all) {
  std::vector<std::string> columns;
  std::vector<std::string> conditions;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::size_t blank = lines[i].find(' ');
    const std::string word = lines[i].substr(0, blank);
    const std::string rest = blank == std::string::npos ? "" : lines[i].substr(blank);
    if (word == "columns")
      columns = split(rest, ';');
    else if (word == "rows")
      std::ranges::copy(split(rest, ';'), std::back_inserter(conditions));
    else
      refuse(fmt::format("{}: not a line of a marker: {}", where, lines[i]));
  }
  std::vector<std::string> table = split(text.substr(0, text.find("\n\n")), '\n');
  std::erase_if(table, [](const std::string& line) { return !line.starts_with('|'); });
  if (table.size() != conditions.size() + 2)
    refuse(fmt::format("{}: {} rows in the marker, {} in the table", where, conditions.size(),
                       static_cast<int>(table.size()) - 2));
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    const std::vector<std::string> cells = cells_of(table[i + 2]);
    const Rows some = selected(rows, words_of(conditions[i]));
    for (std::size_t j = 0; j < columns.size(); ++j) {
      std::vector<std::string> own;  // conditions of the column
      std::vector<std::string> statistics;
      for (const std::string& word : words_of(columns[j]))
        if (word.starts_with('@'))
          own.push_back(word.substr(1));
        else
          statistics.push_back(word);
      if (statistics.empty()) continue;
      if (j >= cells.size()) refuse(fmt::format("{}: row {} has no column {}", where, i + 1, j + 1));
      add_figures(fmt::format("{}, row {}, column {}", where, conditions[i], columns[j]), statistics,
                  selected(some, own), cells[j], all);
    }
  }
}

}  // namespace figures

/// All figures with markers in a page. Throws std::invalid_argument for a marker that cannot be read, an unknown column, conditions that no
/// row meets, and a cell with fewer figures than statistics. `rows_of` gives the rows of a file.
[[nodiscard]] inline std::vector<Figure> figures_of(const std::string& page,
                                                    const std::function<Rows(const std::string&)>& rows_of) {
  const std::string opening = "<!-- figures ";
  std::vector<Figure> all;
  for (std::size_t at = page.find(opening); at != std::string::npos; at = page.find(opening, at + 1)) {
    if (at > 0 && page[at - 1] == '`') continue;  // an example
    const std::size_t end = page.find("-->", at);
    if (end == std::string::npos) figures::refuse("a marker is not closed");
    const std::string marker = page.substr(at + opening.size(), end - at - opening.size());
    const std::string text = page.substr(end + 3);
    const std::vector<std::string> lines = figures::split(marker, '\n');
    const bool in_sentence = lines.size() == 1;
    const std::size_t colon = in_sentence ? lines[0].find(": ") : std::string::npos;
    if (in_sentence && colon == std::string::npos)
      figures::refuse(fmt::format("no statistics in the marker {}", marker));
    const std::string where = lines[0].substr(0, colon);
    std::vector<std::string> words = figures::words_of(where);
    if (words.empty() || (words.size() > 1 && words[1] != "where"))
      figures::refuse(fmt::format("not \"FILE where CONDITIONS\": {}", where));
    const Rows rows = figures::selected(rows_of(words[0]),
                                        {words.begin() + std::min<std::ptrdiff_t>(2, std::ssize(words)), words.end()});
    if (in_sentence)
      figures::add_figures(where, figures::words_of(lines[0].substr(colon + 1)), rows, text, all);
    else
      figures::add_table(where, lines, rows, text.substr(std::min(text.size(), text.find_first_not_of('\n'))), all);
  }
  return all;
}

}  // namespace detp::support
