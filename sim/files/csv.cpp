#include "csv.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <span>
#include <system_error>
#include <utility>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/parallel.hpp"
#include "file_error.hpp"
#include "number_text.hpp"
#include "text_lines.hpp"

namespace detp::sim {
namespace {

class CsvReader {
 public:
  CsvReader(const std::string& path, const ColumnChoice& choice, std::stop_token stop)
      : file_(path, std::move(stop)), lines_(file_), choice_(choice), row_(path, choice(path, {})) {}

  std::size_t read(const TableSink& sink) {
    refuse_other_formats();
    if (!next_line()) throw FileError(file_.path(), "is empty; expected a header " + known_names());
    const bool is_row = read_header();
    for (std::size_t i = 0; i < row_.columns().size(); ++i)
      if (!is_given(i)) row_.set_absent(i);
    std::size_t rows = 0;
    const std::optional<std::uint64_t> begin = file_.rest();
    std::size_t next_pass = rows_of_estimate + 1;  // the number of rows from which on lines are parsed together
    for (bool first = is_row;; first = false) {
      if (rows >= next_pass) {
        rows += read_together(sink);
        next_pass = rows + lines_apart;
      }
      if (!first && !next_line()) return rows;
      read_row();
      if (rows++ == rows_of_estimate && begin) expect_rows(*begin);
      sink(row_);
    }
  }

 private:
  static constexpr std::size_t unused = SIZE_MAX;  ///< a column of the file that is none of the known
  static constexpr std::size_t rows_of_estimate = 64;
  static constexpr std::size_t lines_apart = 256;  ///< where some are not plain numbers

  /// Files that some programs write for tables, by how they begin.
  void refuse_other_formats() {
    struct Format {
      std::string_view begin;
      const char* name;
    };
    using namespace std::string_view_literals;
    constexpr std::array formats{Format{"\x89HDF\r\n"sv, "HDF5"},
                                 Format{"PAR1"sv, "Parquet"},
                                 Format{"ARROW1"sv, "Arrow"},
                                 Format{"PK\x03\x04"sv, "a ZIP archive, as .xlsx is (an .npz must end so)"},
                                 Format{"\xD0\xCF\x11\xE0"sv, "a workbook of Excel"},
                                 Format{"MATLAB 5.0"sv, "a file of MATLAB"},
                                 Format{"CDF\x01"sv, "NetCDF"},
                                 Format{"SQLite format 3"sv, "a database of SQLite"},
                                 Format{"MCPL00"sv, "MCPL, whose name must end in .mcpl"},
                                 Format{"\x93NUMPY"sv, "an array of NumPy, whose name must end in .npy"},
                                 Format{"# vtk DataFile"sv, "a legacy file of VTK"},
                                 Format{"<?xml"sv, "XML"},
                                 Format{"<VTKFile"sv, "a file of VTK"},
                                 Format{"{"sv, "JSON"}};
    constexpr std::size_t longest = 16;
    static_cast<void>(file_.fetch(longest));
    for (const Format& one : formats)
      if (file_.buffered().starts_with(one.begin))
        throw FileError(file_.path(), fmt::format("is {}; CSV, PLY, NPY, NPZ and MCPL are read", one.name));
    constexpr std::string_view ply = "ply";
    const std::string_view front = file_.buffered();
    if (front.starts_with(ply) && front.size() > ply.size() && (front[3] == '\n' || front[3] == '\r'))
      throw FileError(file_.path(), "is PLY, whose name must end in .ply");
  }

  /// By the bytes of the first rows.
  void expect_rows(std::uint64_t begin) {
    constexpr double room = 1.02;
    const auto rest = static_cast<double>(file_.rest().value_or(0));
    const double bytes = static_cast<double>(begin) - rest;
    row_.expect(static_cast<std::size_t>(room * rows_of_estimate * static_cast<double>(begin) / std::max(1.0, bytes)));
  }

  [[nodiscard]] std::string known_names() const {
    std::vector<std::string_view> names;
    for (const TableColumn& column : row_.columns()) names.push_back(column.name);
    return fmt::format("{}", fmt::join(names, ","));
  }

  [[nodiscard]] bool is_given(std::size_t column) const {
    return std::find(order_.begin(), order_.end(), column) != order_.end();
  }

  /// Goes to the next line that is not blank and no comment; false at the end.
  bool next_line() {
    while (lines_.next()) {
      const std::string_view text = trimmed(lines_.line());
      if (text.starts_with('#'))
        comment_ = trimmed(text.substr(1));
      else if (!text.empty() && text != "\x1a" &&              // the end of a file of DOS
               !(order_.empty() && text.starts_with("sep=")))  // a hint for spreadsheets
        return true;
    }
    return false;
  }

  /// The fields of a line, without quotes.
  [[nodiscard]] std::vector<std::string_view> fields_of(std::string_view line) const {
    std::vector<std::string_view> fields;
    if (separator_ == ' ') {
      for (line = trimmed(line); !line.empty();) fields.push_back(cut_word(line));
      return fields;
    }
    while (true) {
      const std::size_t first = std::min(line.find_first_not_of(' '), line.size());
      std::size_t end = line.find(separator_);
      if (line.substr(first).starts_with('"')) {
        std::size_t close = line.find('"', first + 1);
        while (line.substr(std::min(close, line.size())).starts_with("\"\"")) close = line.find('"', close + 2);
        if (close == std::string_view::npos) lines_.fail("a quote has no end");
        end = line.find(separator_, close);
        if (!trimmed(line.substr(close + 1, end == std::string_view::npos ? end : end - close - 1)).empty())
          lines_.fail("there is text between a quote and the next field");
        fields.push_back(trimmed(line.substr(first + 1, close - first - 1)));
      } else {
        fields.push_back(trimmed(line.substr(0, end)));
      }
      if (end == std::string_view::npos) return fields;
      line.remove_prefix(end + 1);
    }
  }

  /// What separates the headings: the first comma, semicolon or tab outside of quotes; else blanks.
  [[nodiscard]] static char separator_in(std::string_view line) {
    bool quoted = false;
    for (const char one : line) {
      if (one == '"') quoted = !quoted;
      if (!quoted && (one == ',' || one == ';' || one == '\t')) return one;
    }
    return ' ';
  }

  [[nodiscard]] static bool are_numbers(const std::vector<std::string_view>& fields) {
    return std::ranges::all_of(fields, [](std::string_view field) { return number_in(field).has_value(); });
  }

  /// Takes the headings; in a comment, if the first line has numbers. Returns whether the line is a row.
  bool read_header() {
    separator_ = separator_in(lines_.line());
    std::vector<std::string_view> fields = fields_of(lines_.line());
    const bool is_row = are_numbers(fields);
    std::vector<std::string> numbers;
    if (is_row) {
      const std::size_t count = fields.size();
      separator_ = separator_in(comment_);
      fields = fields_of(comment_);
      if (fields.size() != count || are_numbers(fields)) {
        numbers = choice_.numbered(count);
        if (numbers.empty())
          lines_.fail("the first line has numbers, and no heading is before it; expected a header " + known_names() +
                      ", or --columns with numbers, as ox=1");
      }
      separator_ = separator_in(lines_.line());
    }
    if (numbers.empty()) numbers.assign(fields.begin(), fields.end());
    const std::vector<std::string> headings = choice_.known(file_.path(), std::move(numbers));
    row_ = TableRow(file_.path(), choice_(file_.path(), headings));
    const std::vector<TableColumn>& columns = row_.columns();
    for (const std::string& heading : headings) {
      const auto known =
          std::ranges::find_if(columns, [&](const TableColumn& column) { return same_heading(column.name, heading); });
      const auto column = static_cast<std::size_t>(known - columns.begin());
      if (known != columns.end() && is_given(column)) lines_.fail(fmt::format("column {} appears twice", heading));
      order_.push_back(known == columns.end() ? unused : column);
    }
    if (const std::string wrong = choice_.sort_out(headings, columns); !wrong.empty()) lines_.fail(wrong);
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (!is_given(i) && !columns[i].absent)
        lines_.fail(fmt::format("the header has no column {}{}; known are {}; it has {}", columns[i].name,
                                columns[i].remedy, known_names(),
                                detp::shortened(fmt::format("{}", fmt::join(headings, " ")))));
    return is_row;
  }

  void set(std::size_t column_of_file, double value) {
    if (order_[column_of_file] != unused) row_.set(order_[column_of_file], value);
  }

  void read_row() {
    const std::string_view line = lines_.line();
    row_.place(lines_.number());
    look_for_points(line);
    if (are_plain_numbers(line, [&](std::size_t i, double value) { set(i, value); })) return;
    const std::vector<std::string_view> fields = fields_of(line);
    if (fields.size() != order_.size())
      lines_.fail(fmt::format("{} fields, but the header has {} columns, separated by {}", fields.size(), order_.size(),
                              separator_ == '\t'  ? "tabs"
                              : separator_ == ' ' ? "blanks"
                              : separator_ == ';' ? "semicolons"
                                                  : "commas"));
    for (std::size_t i = 0; i < fields.size(); ++i)
      if (order_[i] != unused) row_.set(order_[i], number(row_.columns()[order_[i]], fields[i]));
  }

  /// Calls set(i, number) for each column if the line has numbers alone, without blanks, signs + or empty fields, none of them out of the range of
  /// doubles.
  template <class Set>
  [[nodiscard]] bool are_plain_numbers(std::string_view line, const Set& set) const {
    const char* next = line.data();
    const char* const end = next + line.size();
    for (std::size_t i = 0; i < order_.size(); ++i) {
      double value = 0;
      const auto [stop, error] = std::from_chars(next, end, value);
      const bool is_last = i + 1 == order_.size();
      if (error != std::errc{} || (is_last ? stop != end : stop == end || *stop != separator_)) return false;
      set(i, value);
      next = stop + 1;
    }
    return true;
  }

  /// Some lines, and their numbers row by row.
  struct Part {
    std::string_view text = {};
    std::vector<double> numbers = {};
    bool is_plain = true;
  };

  void parse(Part& part) const {
    part.numbers.clear();
    part.is_plain = true;
    for (std::string_view text = part.text; !text.empty();) {
      std::string_view line = text.substr(0, text.find('\n'));
      text.remove_prefix(line.size() + 1);
      if (line.ends_with('\r')) line.remove_suffix(1);
      if (are_plain_numbers(line, [&](std::size_t, double value) { part.numbers.push_back(value); })) continue;
      part.is_plain = false;
      return;
    }
  }

  /// Several threads parse the next lines, as long as these are plain numbers and the file is long. Returns the number of rows.
  std::size_t read_together(const TableSink& sink) {
    constexpr std::size_t at_once = std::size_t{1} << 17;
    constexpr std::size_t of_part = std::size_t{1} << 13;
    lines_.finish_line();
    std::size_t rows = 0;
    std::vector<Part> parts;
    while (file_.fetch(at_once)) {
      std::string_view text = file_.buffered().substr(0, at_once);
      text = text.substr(0, text.rfind('\n') + 1);
      if (text.empty()) return rows;  // a long line
      look_for_points(text);
      std::size_t count_of_parts = 0;
      for (; !text.empty(); ++count_of_parts) {
        const std::size_t end = std::min(text.find('\n', std::min(of_part, text.size() - 1)), text.size() - 1);
        if (count_of_parts == parts.size()) parts.emplace_back();
        parts[count_of_parts].text = text.substr(0, end + 1);
        text.remove_prefix(end + 1);
      }
      sim::parallel_for(std::size_t{0}, count_of_parts, [&](std::size_t i) { parse(parts[i]); });
      for (const Part& part : std::span(parts).first(count_of_parts)) {
        if (!part.is_plain) return rows;
        const std::size_t count = part.numbers.size() / order_.size();
        for (std::size_t i = 0; i < count; ++i) {
          for (std::size_t column = 0; column < order_.size(); ++column)
            set(column, part.numbers[i * order_.size() + column]);
          row_.place(lines_.number() + i + 1);
          sink(row_);
        }
        lines_.skip(count, part.text.size());
        rows += count;
      }
    }
    return rows;
  }

  /// Where fields do not end at commas, decimals may have points or commas, but not both: a comma could stand between thousands.
  void look_for_points(std::string_view text) {
    if (separator_ == ',') return;
    points_ = points_ || text.find('.') != std::string_view::npos;
    require_one_decimal_sign();
  }
  void require_one_decimal_sign() const {
    if (points_ && commas_) lines_.fail("some numbers have decimal points, others decimal commas");
  }

  /// A number as Fortran writes it (1.5D-01), or with a decimal comma where fields do not end at commas, as C writes it.
  [[nodiscard]] std::string in_c(std::string_view field) const {
    std::string text(field);
    if (std::ranges::count_if(text, [](char one) { return one == 'd' || one == 'D'; }) == 1 && text.size() > 1)
      text[text.find_first_of("dD")] = 'e';
    if (separator_ != ',' && std::ranges::count(text, ',') == 1 && text.find('.') == std::string::npos)
      text[text.find(',')] = '.';
    return text;
  }

  [[nodiscard]] double number(const TableColumn& column, std::string_view field) {
    if (field.empty() && column.empty) return *column.empty;
    if (field.empty()) lines_.fail(fmt::format("{} is empty; a number is needed", column.name));
    if (const auto value = number_in(field)) return *value;
    if (const auto value = number_in(in_c(field))) {
      commas_ = commas_ || field.find(',') != std::string_view::npos;
      require_one_decimal_sign();
      return *value;
    }
    lines_.fail(fmt::format("{} is {}, which is not a number{}", column.name, detp::quoted(field),
                            field.find(',') != std::string_view::npos ? "; decimals need a point" : ""));
  }

  InputFile file_;
  TextLines lines_;
  const ColumnChoice& choice_;
  char separator_ = ',';            ///< of fields; ' ': any number of blanks
  bool points_ = false;             ///< some line may have decimal points
  bool commas_ = false;             ///< some number has a decimal comma
  std::string comment_;             ///< the last one before the header
  std::vector<std::size_t> order_;  ///< for each of the file's columns, its index in row_.columns(), or `unused`
  TableRow row_;
};

}  // namespace

std::size_t read_csv(const std::string& path, const ColumnChoice& choice, const TableSink& sink, std::stop_token stop) {
  return CsvReader(path, choice, std::move(stop)).read(sink);
}

}  // namespace detp::sim
