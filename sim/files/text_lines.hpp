#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "input_file.hpp"

namespace detp::sim {

/// The lines of a text file, ended by LF, CR LF or CR. A UTF-8 byte order mark in front is no part of the first line.
///
/// Throws FileError with the line for what is no such text: UTF-16 or UTF-32, a NUL byte, a line beyond `longest`.
class TextLines {
 public:
  static constexpr std::size_t longest = std::size_t{1} << 24;  ///< bytes of one line

  /// Starts where the file stands: at its front. Keeps the reference.
  explicit TextLines(InputFile& file);

  /// Goes to the next line; false at the end of the file. The last line needs no end.
  bool next();

  /// Valid until the file is read again.
  [[nodiscard]] std::string_view line() const { return file_.ahead().substr(0, size_); }

  /// Of the line, from 1; 0 before the first.
  [[nodiscard]] std::size_t number() const { return number_; }

  [[nodiscard]] bool ended_by_cr_alone() const { return cr_alone_; }

  /// Puts the file after the line, for what is no text.
  void finish_line();

  /// Throws FileError with the path and the line.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  void find_end();

  InputFile& file_;
  std::size_t number_ = 0;
  std::size_t size_ = 0;      ///< of the line
  std::size_t end_size_ = 0;  ///< of the line's end
  bool cr_alone_ = false;
};

}  // namespace detp::sim
