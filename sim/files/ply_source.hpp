#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>

#include "input_file.hpp"
#include "number_bytes.hpp"
#include "number_text.hpp"
#include "ply_header.hpp"

/// The numbers of a PLY file's body in sequence.
namespace detp::sim {

/// Numbers as text, separated by blanks and line ends.
class PlyText {
 public:
  PlyText(InputFile& file, std::size_t lines_before) : file_(file), line_(lines_before + 1) {}

  /// The minimum number of bytes of a number: a digit and a separator.
  static std::uint64_t least_size(NumberType) { return 2; }

  /// One more than the number of bytes that follow, because the last number needs no separator; nullopt if unknown.
  [[nodiscard]] std::optional<std::uint64_t> rest() const {
    const auto bytes = file_.rest();
    return bytes ? std::optional(*bytes + 1) : std::nullopt;
  }

  /// The next number; nullopt at the end of the file or if the next word is not a number.
  std::optional<double> next(NumberType) {
    if (at_end()) return std::nullopt;
    std::size_t size = 0;
    do {
      const std::string_view text = file_.buffered();
      size = std::min(text.find_first_of(blanks, size), text.size());
    } while (size == file_.buffered().size() && size <= longest_word && file_.fetch(size + 1));
    if (size > longest_word) return std::nullopt;
    const auto number = number_in(file_.buffered().substr(0, size));
    if (number) file_.skip(size);
    return number;
  }

  /// The reason that there was no next number.
  [[nodiscard]] std::string missing_number_reason(const std::string& name) const {
    return file_.buffered().empty() ? "the file ends early" : "its " + name + " is not a number";
  }

  /// Whether only blanks are left; skips blanks.
  [[nodiscard]] bool at_end() {
    while (file_.fetch(1)) {
      const std::string_view text = file_.buffered();
      const std::size_t skipped = std::min(text.find_first_not_of(blanks), text.size());
      line_ += static_cast<std::size_t>(std::count(text.begin(), text.begin() + static_cast<long>(skipped), '\n'));
      file_.skip(skipped);
      if (!file_.buffered().empty()) return false;
    }
    return true;
  }

  [[nodiscard]] std::string where() const { return " (line " + std::to_string(line_) + ")"; }

 private:
  static constexpr const char* blanks = " \t\r\n";
  static constexpr std::size_t longest_word = 4096;

  InputFile& file_;
  std::size_t line_;
};

/// Numbers in binary.
class PlyBytes {
 public:
  PlyBytes(InputFile& file, std::endian order) : file_(file), swapped_(order != std::endian::native) {}

  static std::uint64_t least_size(NumberType type) { return size_of(type); }
  [[nodiscard]] std::optional<std::uint64_t> rest() const { return file_.rest(); }

  std::optional<double> next(NumberType type) {
    if (!file_.fetch(size_of(type))) return std::nullopt;
    const double number = number_at(file_.buffered().data(), type, swapped_);
    file_.skip(size_of(type));
    return number;
  }

  [[nodiscard]] static std::string missing_number_reason(const std::string&) { return "the file ends early"; }

  /// A binary file may have bytes after its last element: many writers append a line feed.
  [[nodiscard]] static bool at_end() { return true; }
  [[nodiscard]] static std::string where() { return {}; }

 private:
  InputFile& file_;
  bool swapped_;
};

}  // namespace detp::sim
