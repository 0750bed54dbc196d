#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

/// --instruction-set: what other machines would do.
namespace detp::cli {

class InstructionSetOption {
 public:
  void add_to(CLI::App& command, const std::string& whose);

  /// The sets in the order given; one empty name, all that the machine has, if none was given. Throws std::invalid_argument for a set that
  /// the kernels were not compiled for, or that this machine lacks.
  [[nodiscard]] std::vector<std::string> sets() const;

  /// The only set. Throws std::invalid_argument if several were given, too.
  [[nodiscard]] std::string only() const;

 private:
  std::vector<std::string> sets_;
};

}  // namespace detp::cli
