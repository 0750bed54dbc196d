#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "output_file.hpp"
#include "writing_check.hpp"

namespace detp::sim {

/// Writes a file of numbers in named columns, so that read_table finds the same doubles: PLY, binary, if the path ends in .ply
/// (upper or lower case), a structured array of NumPy if in .npy, CSV if it ends in .csv or has no suffix.
class TableWriter {
 public:
  /// `unit` names the rows in the plural, a string of static storage. Throws FileError for another suffix, and if the file
  /// cannot be written.
  TableWriter(const std::string& path, const std::vector<std::string_view>& columns, std::uint64_t rows,
              const char* unit, const std::stop_token& stop);

  /// Writes the next row: a number for each column. Throws FileError and Stopped.
  void write(std::span<const double> row);

  /// The file appears.
  void commit() { file_.commit(); }

 private:
  std::string suffix_;
  WritingCheck check_;
  OutputFile file_;
};

/// The ending of a file's name that says its format, in lower case: ".ply" for "a/TREE.PLY". Empty if there is none. An ending
/// is a dot after another letter, and 1 to 5 letters or digits that are not all digits: names such as run-0.5, tmp.Q2xJmC7d9k and
/// .out have none.
[[nodiscard]] std::string suffix_of(std::string_view path);

}  // namespace detp::sim
