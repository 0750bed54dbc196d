#pragma once

#include <map>
#include <string>
#include <vector>

#include "command.hpp"

/// Reads CSV results according to RFC 4180.
namespace detp::support {

using CsvRow = std::map<std::string, std::string>;

/// The fields of each record. Fails the test if a quote is not closed, or if the last line does not end.
inline std::vector<std::vector<std::string>> csv_records(const std::string& csv) {
  std::vector<std::vector<std::string>> records;
  std::string field;
  bool quoted = false;
  bool begun = false;
  const auto end_field = [&] {
    if (!begun) records.emplace_back();
    begun = true;
    records.back().push_back(field);
    field.clear();
  };
  for (std::size_t i = 0; i < csv.size(); ++i) {
    if (quoted && csv[i] == '"' && i + 1 < csv.size() && csv[i + 1] == '"') {
      field += csv[i++];
    } else if (csv[i] == '"') {
      quoted = !quoted;
    } else if (!quoted && (csv[i] == ',' || csv[i] == '\n')) {
      end_field();
      begun = csv[i] == ',';
    } else {
      field += csv[i];
    }
  }
  REQUIRE_FALSE(quoted);
  REQUIRE(field.empty());
  return records;
}

/// The rows by column. Fails the test unless the header's names are distinct and every row has as many fields.
inline std::vector<CsvRow> csv_rows(const std::string& csv) {
  const auto records = csv_records(csv);
  REQUIRE_FALSE(records.empty());
  std::vector<CsvRow> rows;
  for (std::size_t i = 1; i < records.size(); ++i) {
    REQUIRE(records[i].size() == records[0].size());
    CsvRow row;
    for (std::size_t j = 0; j < records[i].size(); ++j) row[records[0][j]] = records[i][j];
    REQUIRE(row.size() == records[0].size());
    rows.push_back(std::move(row));
  }
  return rows;
}

/// The CSV result of a command that must succeed.
inline std::vector<CsvRow> csv_of(const Arguments& arguments) {
  const Finished finished = detp(arguments + words("--format csv"));
  INFO("line_of(arguments) ", line_of(arguments), ", finished.err ", finished.err);
  REQUIRE(finished.code == 0);
  return csv_rows(finished.out);
}
inline std::vector<CsvRow> csv_of(const std::string& line) { return csv_of(words(line)); }

inline double number(const CsvRow& row, const std::string& column) {
  CAPTURE(column);
  REQUIRE(row.contains(column));
  return std::stod(row.at(column));
}

}  // namespace detp::support
