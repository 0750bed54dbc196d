#include <doctest/doctest.h>

#include <stdexcept>
#include <string>

#include "detp/sim/files/file_error.hpp"
#include "detp/validate/base/json.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/calibration/calibrate_answer.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "support/scratch_file.hpp"

using namespace detp;
using validate::costs_in_use;

TEST_SUITE("known answer") {
  TEST_CASE(
      "given costs are those of all techniques and both engines; without a calibration they are the built-in ones") {
    const validate::CostsInUse given = costs_in_use({.given = UnitCosts{.disc_test = 2e-9}, .calibration = "none"});
    CHECK(given.plain[Technique::grid].disc_test == 2e-9);
    CHECK(given.plain.engine == Engine::plain);
    CHECK_FALSE(given.built_in);
    CHECK(validate::to_json(given.simd).at("u") == 2e-9);
    const validate::CostsInUse none = costs_in_use({.calibration = "none"});
    CHECK(none.built_in);
    CHECK(none.of(Engine::simd) == validate::built_in_unit_costs());
    CHECK(validate::to_json(none.simd).at("grid").size() > 3);
  }

  TEST_CASE("a named calibration of this machine is used, with its error and doubt; one of elsewhere is refused") {
    const support::ScratchFolder folder;
    validate::Calibration calibration;
    calibration.plain = validate::built_in_unit_costs(Engine::plain);
    calibration.simd = validate::built_in_unit_costs();
    calibration.simd[Technique::grid].step = 1.25e-8;
    calibration.left_out_median_error = 0.3;
    const std::string text = validate::calibration_text(calibration);
    const validate::CostsInUse found = costs_in_use({.calibration = folder.file("mine.json", text)});
    CHECK(found.simd[Technique::grid].step == 1.25e-8);
    CHECK(found.relative_error == calibration.relative_error());
    CHECK(found.doubt == calibration.doubt());
    CHECK(found.origin.find("of this machine, calibrated") != std::string::npos);
    CHECK_THROWS_AS(static_cast<void>(costs_in_use({.calibration = folder.path("missing.json")})), sim::FileError);
  }

  TEST_CASE(
      "each field of an answer of calibrate has a meaning, and the fits of a calibration are rows under their "
      "columns") {
    for (const validate::FieldText& field : validate::describe_calibrate()) CHECK_FALSE(field.meaning.empty());
    validate::MeasuredCalibration calibration;
    calibration.fits.push_back(
        {{.technique = Technique::grid, .runs = 12, .left_out_errors = {0.1, 0.3}}, {.step = 2e-9}});
    calibration.thread_fits.push_back({{.technique = Technique::grid, .left_out_errors = {0.5}}, {.start = 1e-5}});
    const auto rows = validate::calibrate_rows(calibration);
    const validate::Columns columns = validate::calibrate_columns();
    for (const validate::Json& row : rows)
      for (const auto& [column, value] : row.items())
        CHECK(std::find(columns.begin(), columns.end(), column) != columns.end());
    CHECK(rows.front().at("left_out_median_error").get<double>() == doctest::Approx(0.2));
    CHECK(rows.back().at("symbol") == "thread");
    CHECK(rows.back().at("seconds") == 1e-5);
    CHECK_FALSE(rows.back().contains("condition"));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a calibration of no time is refused") {
    CHECK_THROWS_AS(static_cast<void>(validate::answer(validate::CalibrateRequest{.seconds = 0})),
                    std::invalid_argument);
  }
}
