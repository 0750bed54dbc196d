#include "detp/sim/technique/registry.hpp"

#include <doctest/doctest.h>

using namespace detp;

TEST_SUITE("identity") {
  TEST_CASE("every technique has its own entry, which prepares its search") {
    for (const Technique technique : all_techniques) {
      CAPTURE(name(technique));
      CHECK(sim::search_of(technique).technique == technique);
      CHECK((sim::search_of(technique).prepare != nullptr));
    }
  }
}
