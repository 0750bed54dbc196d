#pragma once

#include <doctest/doctest.h>

#include "detp/sim/lists/simd/instruction_sets.hpp"
#include "detp/sim/lists/simd/list_search.hpp"

namespace detp::support {

/// Calls check() with each instruction set that the machine has.
template <class Check>
void with_each_instruction_set(const Check& check) {
  for (const sim::stream::InstructionSet& set : sim::stream::compiled_instruction_sets()) {
    if (!set.here) continue;
    const sim::stream::OnlyInstructionSet only(set.name);
    CAPTURE(set.name);
    REQUIRE(sim::stream::instruction_set() == set.name);
    check();
  }
}

}  // namespace detp::support
