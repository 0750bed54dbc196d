#include "detp/model/techniques/registry.hpp"

#include <doctest/doctest.h>

#include <algorithm>

using namespace detp;
using namespace detp::model;

TEST_SUITE("identity") {
  TEST_CASE("each prediction of a technique with numbers has a search for the best ones and a check of its range") {
    for (const Technique technique : all_techniques) {
      const TechniqueModel& model = model_of(technique);
      CAPTURE(name(technique));
      const bool has_numbers = std::ranges::any_of(
          record_of(technique).parameters, [](const Parameter& parameter) { return parameter.choices.empty(); });
      CHECK((model.best != nullptr) == (has_closed_form(technique) && has_numbers));
      CHECK((model.uncounted != nullptr) == (has_closed_form(technique) && has_numbers));
    }
  }
}
