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

}  // namespace detp::sim
