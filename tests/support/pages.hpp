#pragma once

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "csv_answer.hpp"

/// Pages of the project, and the data whose figures they quote.
namespace detp::support {

/// The content of a file of the project, which must not be empty. `path` starts at the top folder.
inline std::string source_text(const std::string& path) {
  const std::string text = content_of(DETP_SOURCE "/" + path);
  CAPTURE(path);
  REQUIRE_FALSE(text.empty());
  return text;
}

/// The rows of a file of notebooks-data.
inline std::vector<CsvRow> published(const std::string& file) {
  return csv_rows(source_text("notebooks-data/" + file));
}

inline void check_says(const std::string& page, const std::string& expected) {
  CAPTURE(expected);
  CHECK(page.find(expected) != std::string::npos);
}

}  // namespace detp::support
