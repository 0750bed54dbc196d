#include "detp/validate/calibration/calibration_file.hpp"

#include <doctest/doctest.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "detp/sim/files/file_error.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "support/scratch_file.hpp"

using namespace detp;

namespace {

validate::Calibration some_calibration() {
  validate::Calibration calibration;
  calibration.plain.costs = validate::built_in_unit_costs(Engine::plain);
  calibration.simd.costs = validate::built_in_unit_costs();
  calibration.simd.costs[Technique::grid].step = 1.25e-8;
  calibration.plain.costs[Technique::box_tree].cull_test = 1.5e-8;
  calibration.simd.costs.threads_of(Technique::bsp) = {.serial_preparing = 1, .serial_search = 0.0625, .start = 1.5e-5};
  calibration.left_out_median_error = 0.0625;
  return calibration;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t place = text.find(what);
  REQUIRE(place != std::string::npos);
  return text.replace(place, what.size(), by);
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("a calibration is read back as it was written") {
    const support::ScratchFolder folder;
    const std::string path = folder.path("made/for/it/calibration.json");
    validate::write_calibration(path, some_calibration());
    const validate::StoredCalibration stored = validate::read_calibration(path);
    CHECK(stored.key == validate::this_machine());
    CHECK(stored.left_out_median_error == 0.0625);
    CHECK(stored.date.size() == 10);
    const validate::Calibration written = some_calibration();
    CHECK(stored.plain.engine == Engine::plain);
    CHECK(stored.simd.engine == Engine::simd);
    for (const Technique technique : all_techniques)
      if (record_of(technique).exact) {
        CHECK(stored.plain[technique] == written.plain.costs[technique]);
        CHECK(stored.simd[technique] == written.simd.costs[technique]);
        CHECK(stored.simd.threads_of(technique) == written.simd.costs.threads_of(technique));
      }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("what is no calibration is refused with its file's name") {
    const std::string good = validate::calibration_text(some_calibration());
    CHECK_NOTHROW(static_cast<void>(validate::parse_calibration(good, "c.json")));
    for (const std::string& bad :
         {std::string(), std::string("{"), std::string("[]"), std::string("{\"schema\": 1}"),
          good.substr(0, good.size() / 2), replaced(good, "detp.calibrate", "detp.run"),
          replaced(good, "\"version\": 1", "\"version\": 2"),
          replaced(good, "\"left_out_median_error\": 0.0625", "\"left_out_median_error\": -1"),
          replaced(good, "\"serial_search\": 0.0625", "\"serial_search\": 1.5"),
          replaced(good, "\"serial_search\": 0.0625", "\"serial\": 0.5"),
          replaced(good, "\"v\": 1.25e-08", "\"v\": -1"), replaced(good, "\"v\": 1.25e-08", "\"v\": \"x\"")}) {
      CAPTURE(bad);
      CHECK_THROWS_WITH_AS(static_cast<void>(validate::parse_calibration(bad, "c.json")), doctest::Contains("c.json: "),
                           sim::FileError);
    }
  }

  TEST_CASE("a calibration with another version of the cost model is refused, and the message says why") {
    const std::string good = validate::calibration_text(some_calibration());
    const std::string here = std::to_string(validate::this_machine().cost_model);
    const std::string older = replaced(good, "\"cost_model\": " + here, "\"cost_model\": 2");
    CHECK_THROWS_WITH_AS(static_cast<void>(validate::parse_calibration(older, "c.json")),
                         doctest::Contains("version 2 of the cost model"), sim::FileError);
    // as it was before the file had the costs of both engines and of threads
    const std::string flat =
        "{\"schema\": {\"name\": \"detp.calibrate\", \"version\": 1}, \"key\": {\"cost_model\": 2}, "
        "\"costs\": {\"grid\": {\"w\": 1e-9}}}";
    CHECK_THROWS_WITH_AS(static_cast<void>(validate::parse_calibration(flat, "c.json")),
                         doctest::Contains("threads; make a new one with detp calibrate"), sim::FileError);
  }

  TEST_CASE("a missing file is refused") {
    CHECK_THROWS_AS(static_cast<void>(validate::read_calibration("/nowhere/calibration.json")), sim::FileError);
  }
}
