#pragma once

#include <initializer_list>
#include <optional>
#include <string>

namespace detp::cli {

/// A file that a command will write, and the option that names it.
struct Output {
  std::string option;
  std::optional<std::string> path;
};

/// Throws sim::FileError if a file cannot be written, and std::invalid_argument if two options name the same file, even
/// by different paths.
void check_outputs(std::initializer_list<Output> outputs);

}  // namespace detp::cli
