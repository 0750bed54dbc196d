#include "instruction_sets.hpp"

#include <hwy/targets.h>

#include <cstdint>
#include <stdexcept>

#include "detp/model/vocabulary/quoted.hpp"

namespace detp::sim::stream {
namespace {

std::vector<std::int64_t> compiled_targets() {
  std::vector<std::int64_t> targets;
  for (std::int64_t left = HWY_TARGETS; left != 0; left &= left - 1) targets.push_back(left & -left);
  return targets;
}

bool is_here(std::int64_t target) { return ((hwy::SupportedTargets() | HWY_STATIC_TARGET) & target) != 0; }

/// 0: as many as the machine has.
void use_targets(std::int64_t targets) {
  hwy::SetSupportedTargetsForTest(targets);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace

std::vector<InstructionSet> compiled_instruction_sets() {
  std::vector<InstructionSet> sets;
  for (const std::int64_t target : compiled_targets()) sets.push_back({hwy::TargetName(target), is_here(target)});
  return sets;
}

OnlyInstructionSet::OnlyInstructionSet(const std::string& name) {
  for (const std::int64_t target : compiled_targets())
    if (name == hwy::TargetName(target) && is_here(target)) {
      use_targets(target);
      return;
    }
  std::string here;
  for (const InstructionSet& set : compiled_instruction_sets())
    if (set.here) here += (here.empty() ? "" : ", ") + set.name;
  throw std::invalid_argument("the kernels cannot use the instruction set " + detp::quoted(name) +
                              " on this machine; it has " + here);
}

OnlyInstructionSet::~OnlyInstructionSet() { use_targets(0); }

}  // namespace detp::sim::stream
