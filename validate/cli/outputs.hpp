#pragma once

#include <initializer_list>
#include <optional>
#include <string>

namespace detp::cli {

/// A file that a command is to write, and the option that names it.
struct Output {
  std::string option;
  std::optional<std::string> path;
};

/// Refuses, before any work, what could not be written after it. Throws sim::FileError where a file cannot be written,
/// and std::invalid_argument where two options name one place, however they spell it.
void check_outputs(std::initializer_list<Output> outputs);

}  // namespace detp::cli
