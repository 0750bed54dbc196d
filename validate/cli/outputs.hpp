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

/// Checks the outputs before any work. Throws sim::FileError if a file cannot be written, and std::invalid_argument if
/// two options name the same place, however they spell it.
void check_outputs(std::initializer_list<Output> outputs);

}  // namespace detp::cli
