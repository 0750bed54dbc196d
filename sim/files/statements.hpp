#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>

#include "detp/sim/scene/mesh.hpp"
#include "input_file.hpp"
#include "text_lines.hpp"

namespace detp::sim {

/// A format whose files consist of lines "keyword arguments".
struct StatementFormat {
  std::string_view name;  ///< "OBJ"
  std::span<const std::string_view> keywords;
  bool any_capitals = false;  ///< keywords may have other capitals
};

extern const StatementFormat obj_format;
extern const StatementFormat mtl_format;

/// The text up to a # that begins it or follows a blank, without the blanks before.
[[nodiscard]] std::string_view without_comment(std::string_view text);

/// The statements of such a file, without comments and blank lines. Lines that a backslash continues are joined.
class Statements {
 public:
  Statements(const std::string& path, const StatementFormat& format, std::stop_token stop);

  /// Goes to the next statement with a known keyword; false at the end of the file. Throws FileError if most
  /// statements have unknown keywords, and as TextLines does.
  bool next();

  [[nodiscard]] std::string_view keyword() const { return keyword_; }
  /// The text after the keyword, without a comment. Valid until next().
  [[nodiscard]] std::string_view rest() const { return without_comment(rest_); }
  /// The name after the keyword, which may have blanks and #; without_comment is for the caller. Valid until next().
  [[nodiscard]] std::string_view name() const;

  /// Number of the statement's line, the first of joined lines.
  [[nodiscard]] std::size_t line() const { return number_; }
  /// Throws FileError with the line, the first of joined lines.
  [[noreturn]] void fail(const std::string& what) const;

  /// The number in a word. "1.#IND" and the like, as older Microsoft libraries print NaN and infinity, are NaN. Throws
  /// FileError for an empty word and for other text.
  [[nodiscard]] double number(std::string_view word) const;

  /// Adds a notice of the statements that were skipped.
  void note_unknown(Notices& notices) const;

 private:
  [[nodiscard]] std::string_view joined();
  [[nodiscard]] std::string_view known_keyword() const;
  void count_unknown();

  const StatementFormat& format_;
  InputFile file_;
  TextLines lines_;
  std::string joined_;
  std::string_view keyword_;
  std::string_view rest_;
  std::size_t number_ = 0;  ///< line number of the statement's first line
  std::uint64_t known_ = 0;
  std::uint64_t unknown_ = 0;
  std::string first_unknown_;
};

}  // namespace detp::sim
