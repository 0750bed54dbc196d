#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

#include "detp/model/vocabulary/quoted.hpp"

namespace detp::sim {

/// A file that cannot be read or written, or whose content is wrong. The message is one line that says where, what is
/// wrong, and what would be right, such as "rays.csv:17: direction is zero; a direction needs a length". Text quoted
/// from a file must pass through detp::quoted() or escaped().
class FileError : public std::runtime_error {
 public:
  FileError(const std::string& path, const std::string& what) : std::runtime_error(shown_path(path) + ": " + what) {}
  FileError(const std::string& path, std::size_t line, const std::string& what)
      : std::runtime_error(shown_path(path) + ":" + std::to_string(line) + ": " + what) {}
};

}  // namespace detp::sim
