#pragma once

#include <hwy/targets.h>

#include <cstdint>
#include <vector>

/// The instruction sets for which the kernels were compiled.
namespace detp::support {

/// Makes the kernels use one of the machine's instruction sets until the end of a scope.
class OnlyInstructionSet {
 public:
  explicit OnlyInstructionSet(std::int64_t target) { use(target); }
  ~OnlyInstructionSet() { use(0); }  // 0: the default choice
  OnlyInstructionSet(const OnlyInstructionSet&) = delete;
  OnlyInstructionSet& operator=(const OnlyInstructionSet&) = delete;

 private:
  static void use(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

/// All compiled instruction sets, best first. The last one runs on every machine.
inline std::vector<std::int64_t> compiled_instruction_sets() {
  std::vector<std::int64_t> sets;
  for (std::int64_t left = HWY_TARGETS; left != 0; left &= left - 1) sets.push_back(left & -left);
  return sets;
}

inline bool machine_has(std::int64_t target) { return ((hwy::SupportedTargets() | HWY_STATIC_TARGET) & target) != 0; }

}  // namespace detp::support
