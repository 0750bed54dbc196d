#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "input_file.hpp"
#include "ply_header.hpp"

/// PLY files: ascii, binary of both byte orders, all number types, lists.
namespace detp::sim {

/// One row's values of each requested property: one number, or the entries of a list. A double holds every PLY number
/// exactly.
using PlyValues = std::vector<std::vector<double>>;

/// A request for properties of one element.
struct PlyRequest {
  std::string element;
  std::vector<std::size_t> properties;  ///< the properties' places in the element
  /// receives each row, numbered from 0; may throw
  std::function<void(std::uint64_t row, const PlyValues& values)> on_row;
};

/// A PLY file. Its rows are passed on one by one.
class PlyFile {
 public:
  /// Opens the file and reads the header. Throws FileError with the line if it is unreadable or malformed; and Stopped.
  explicit PlyFile(const std::string& path, std::stop_token stop = {});

  /// The element of that name; null if the file has none.
  [[nodiscard]] const PlyElement* element(std::string_view name) const;

  [[nodiscard]] const std::vector<PlyElement>& elements() const { return header_.elements; }

  /// Reads the body in the file's order, and skips elements that were not requested. Can be called once.
  ///
  /// Throws FileError if the file is unreadable, malformed or truncated, or is an ascii file with more numbers than its
  /// header declares. For a malformed row the message has the element and the row counted from 1 ("vertex 17 of 100").
  /// Throws Stopped.
  void read(const std::vector<PlyRequest>& requests);

 private:
  InputFile file_;
  PlyHeader header_;
};

}  // namespace detp::sim
