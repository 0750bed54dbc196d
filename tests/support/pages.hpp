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

/// The text with each paragraph on one line. Lines of tables stay apart.
inline std::string unwrapped(const std::string& text) {
  std::string joined;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t next = text.find_first_not_of(' ', i + 1);
    const bool breaks_prose = text[i] == '\n' && i > 0 && next != std::string::npos && text[i - 1] != '|' &&
                              text[i - 1] != '\n' && text[next] != '|' && text[next] != '\n';
    joined += breaks_prose ? ' ' : text[i];
    if (breaks_prose) i = next - 1;
  }
  return joined;
}

/// The page must have the expected text, wherever its lines end.
inline void check_says(const std::string& page, const std::string& expected) {
  CAPTURE(expected);
  CHECK(unwrapped(page).find(unwrapped(expected)) != std::string::npos);
}

}  // namespace detp::support
