#include "detp/validate/closed_forms/closed_forms.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <stdexcept>

namespace detp::validate {
namespace {

ModelRequest request_for(Technique technique) {
  return {.workload = cube_workload(1e5, 1e4, 0.02, 2), .technique = technique};
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("every technique with a closed form has an answer, whose parts make its total") {
    for (const Technique technique : exact_techniques) {
      CAPTURE(name(technique));
      if (!model::has_closed_form(technique)) {
        CHECK_THROWS_AS(static_cast<void>(answer(request_for(technique))), std::invalid_argument);
        continue;
      }
      const ModelAnswer found = answer(request_for(technique));
      const ModelTimes& times = found.times;
      CHECK(found.candidate.technique == technique);
      double parts = 0;
      for (const auto& part : {times.rebuild, times.intersect, times.copy, times.order, times.build, times.traverse})
        parts += part.value_or(0);
      CHECK(parts == doctest::Approx(times.total).epsilon(1e-9));
    }
  }

  TEST_CASE("the other form and the best parameters are no slower than by their own formula") {
    const ModelRequest request = request_for(Technique::sphere_cache);
    const ModelAnswer found = answer(request);
    const ModelComparison than = compare(request, found);
    CHECK(than.best_time <= found.times.total);
    REQUIRE(than.other_form);
    CHECK(than.other_form->form == Form::published);
    CHECK(than.other_form->stops->spheres == found.stops->published);
  }
}

TEST_SUITE("fields") {
  TEST_CASE("every cell of a row has a column, and every field a meaning") {
    const Columns all = model_columns() + validate::Columns{"technique", "parameters"};
    for (const Technique technique : {Technique::sphere_cache, Technique::octree, Technique::sphere_tree}) {
      ModelRequest request = request_for(technique);
      request.target_error = 0.05;
      request.curvature = -3;
      const std::vector<Json> rows = cells_of(request, answer(request));
      CHECK(rows.front().contains("total_time"));
      CHECK(rows.front().contains("nearest_for_error"));
      for (const auto& [column, value] : rows.front().items()) {
        const std::string& name = column;
        CAPTURE(name);
        const bool is_parameter = find_parameter(technique, name) != nullptr || name == "fan_out";
        CHECK((is_parameter || std::ranges::find(all, name) != all.end()));
        CHECK_FALSE(value.is_structured());
      }
    }
    for (const FieldText& field : describe_model()) CHECK_FALSE(field.meaning.empty());
  }
}

}  // namespace detp::validate
