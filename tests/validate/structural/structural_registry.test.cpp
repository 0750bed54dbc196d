#include "detp/validate/structural/structural_registry.hpp"

#include <doctest/doctest.h>

using namespace detp;

TEST_SUITE("identity") {
  TEST_CASE("every technique has its own entry: its counts, or the reason why there are none") {
    for (const Technique technique : all_techniques) {
      const validate::StructuralTier& tier = validate::structural_tier(technique);
      CAPTURE(name(technique));
      CHECK(tier.technique == technique);
      CHECK((tier.counts == nullptr) == !tier.why_none.empty());
    }
  }
}
