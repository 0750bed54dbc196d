#include "detp/validate/structural/structural_registry.hpp"

#include <doctest/doctest.h>

using namespace detp;

TEST_SUITE("identity") {
  TEST_CASE("every technique has its own entry: its counts, or the reason why there are none") {
    for (const Technique technique : all_techniques) {
      const validate::StructuralModel model = validate::structural_model(technique);
      CAPTURE(name(technique));
      CHECK(model.technique == technique);
      CHECK((model.counts == nullptr) == !model.why_none.empty());
    }
  }
}
