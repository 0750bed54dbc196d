#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "output_file.hpp"
#include "writing_check.hpp"

/// Files of results, which other programs open: a row of named numbers for each point or triangle.
namespace detp::sim {

struct ResultColumn {
  enum class Kind {
    real,   ///< a double; in CSV empty where it is not finite
    count,  ///< a whole number
    index   ///< a whole number from -1 to 2³¹ - 1
  };
  std::string name;
  Kind kind = Kind::real;
  /// Of an index: what CSV has in its place, if there are any; -1 is empty. Other formats have a comment with all.
  std::vector<std::string> names = {};
};

/// Where the rows of a file are. The columns x, y, z have their places, nx, ny, nz their normals.
struct ResultPlaces {
  std::span<const glm::dvec3> corners = {};  ///< of the triangles, each of which is a row; empty: rows are points
  /// Of corners, or of rows that are points; none: points alone.
  std::span<const std::array<std::uint32_t, 3>> triangles = {};
};

/// Writes results in the format of the path's suffix: CSV if it is .csv or there is none; a structured array of NumPy for .npy;
/// binary PLY for .ply, points or a mesh with properties of its vertices or faces; VTK PolyData for .vtp (XML with appended binary
/// arrays, as ParaView reads). Whole numbers are int64 in .npy and .vtp; in .ply, which has none, indices are int and counts double.
class ResultFile {
 public:
  /// `unit` names the rows in the plural, a string of static storage. The places must stay
  /// until the end. Throws FileError for another suffix, and if the file cannot be written; std::length_error if a .vtp, which is written
  /// column by column, would not fit in memory.
  ResultFile(const std::string& path, std::vector<ResultColumn> columns, std::uint64_t rows, const ResultPlaces& places,
             const char* unit, const std::stop_token& stop);

  /// Writes the next row: a number for each column. Throws FileError and Stopped.
  void write(std::span<const double> row);

  /// The file appears.
  void commit();

 private:
  void write_ply_header();
  void write_vtp();
  [[nodiscard]] std::size_t column(std::string_view name) const;
  [[nodiscard]] bool rows_are_triangles() const { return !places_.corners.empty(); }
  void write_number(double number, ResultColumn::Kind kind);

  std::string path_;
  std::string suffix_;
  std::vector<ResultColumn> columns_;
  std::uint64_t rows_;
  ResultPlaces places_;
  std::vector<std::string> comments_;
  std::vector<std::vector<double>> kept_;  ///< by column, of a .vtp
  std::uint64_t written_ = 0;
  WritingCheck check_;
  OutputFile file_;
};

}  // namespace detp::sim
