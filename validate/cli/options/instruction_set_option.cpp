#include "instruction_set_option.hpp"

#include <stdexcept>

#include "detp/sim/lists/simd/instruction_sets.hpp"

namespace detp::cli {

void InstructionSetOption::add_to(CLI::App& command, const std::string& whose) {
  command
      .add_option("--instruction-set", sets_,
                  "instruction set of " + whose + ": AVX3 (AVX-512), AVX2, SSE4; default: the best of this machine")
      ->delimiter(',');
}

std::vector<std::string> InstructionSetOption::sets() const {
  if (sets_.empty()) return {""};
  for (const std::string& set : sets_) const sim::stream::OnlyInstructionSet here(set);
  return sets_;
}

std::string InstructionSetOption::only() const {
  const std::vector<std::string> all = sets();
  if (all.size() > 1) throw std::invalid_argument("--instruction-set takes only one here");
  return all.front();
}

}  // namespace detp::cli
