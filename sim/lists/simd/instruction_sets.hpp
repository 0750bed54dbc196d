#pragma once

#include <string>
#include <vector>

/// The instruction sets for which the kernels were compiled.
namespace detp::sim::stream {

struct InstructionSet {
  std::string name;   ///< "AVX3", …, as instruction_set() returns it
  bool here = false;  ///< this machine has it
};

/// All of them, best first. Every machine has the last one.
[[nodiscard]] std::vector<InstructionSet> compiled_instruction_sets();

/// Makes the kernels of the whole program use one instruction set until the end of a scope: for tests, and to see what
/// other machines would do. No search may run while one is made or ends.
class OnlyInstructionSet {
 public:
  /// Throws std::invalid_argument if the kernels were not compiled for it, or if this machine lacks it.
  explicit OnlyInstructionSet(const std::string& name);
  ~OnlyInstructionSet();
  OnlyInstructionSet(const OnlyInstructionSet&) = delete;
  OnlyInstructionSet& operator=(const OnlyInstructionSet&) = delete;
};

}  // namespace detp::sim::stream
