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

/// Of one row, the entries of each wanted property: one number, or those of a list. All types of PLY fit a double
/// exactly.
using PlyValues = std::vector<std::vector<double>>;

/// What is wanted of an element.
struct PlyWish {
  std::string element;
  std::vector<std::size_t> properties;                                   ///< their places in the element
  std::function<void(std::uint64_t row, const PlyValues& values)> take;  ///< takes each row, from 0; may throw
};

/// A PLY file, whose rows are handed on one by one.
class PlyFile {
 public:
  /// Opens and reads the header. Throws FileError with the line: unreadable, malformed; and Stopped.
  explicit PlyFile(const std::string& path, std::stop_token stop = {});

  /// The element of that name; null if the file has none.
  [[nodiscard]] const PlyElement* element(std::string_view name) const;

  /// Reads the body, in its order; what is not wanted is read over. Can be called once.
  ///
  /// Throws FileError with the element and its row counting from 1 ("vertex 17 of 100"): unreadable, malformed,
  /// truncated, or an ascii file with more numbers than its header says. Throws Stopped.
  void read(const std::vector<PlyWish>& wishes);

 private:
  InputFile file_;
  PlyHeader header_;
};

}  // namespace detp::sim
