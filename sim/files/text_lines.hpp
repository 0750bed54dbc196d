#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "input_file.hpp"

namespace detp::sim {

/// The lines of a text file, which end in LF, CR LF or CR. A leading UTF-8 byte order mark is skipped.
///
/// Throws FileError for UTF-16 or UTF-32 and, with the line, for a NUL byte or a line longer than `longest`.
class TextLines {
 public:
  static constexpr std::size_t longest = std::size_t{1} << 24;  ///< bytes in one line

  /// Starts at the file's position, which must be its front. Keeps the reference.
  explicit TextLines(InputFile& file);

  /// Goes to the next line; false at the end of the file. The last line needs no line end.
  bool next();

  /// Valid until the file is read again.
  [[nodiscard]] std::string_view line() const { return file_.buffered().substr(0, size_); }

  /// Line number, from 1; 0 before the first line.
  [[nodiscard]] std::size_t number() const { return number_; }

  [[nodiscard]] bool ended_by_cr_alone() const { return cr_alone_; }

  /// Moves the file's position behind the line, so that a caller can read binary data after the line.
  void finish_line();

  /// Moves the file's position behind so many whole lines, which have so many bytes. To be called after finish_line.
  void skip(std::size_t lines, std::size_t bytes) {
    number_ += lines;
    file_.skip(bytes);
  }

  /// Throws FileError with the path and the line.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  void find_end();

  InputFile& file_;
  std::size_t number_ = 0;
  std::size_t size_ = 0;      ///< of the line, without its end
  std::size_t end_size_ = 0;  ///< of the line's end
  bool cr_alone_ = false;
};

}  // namespace detp::sim
