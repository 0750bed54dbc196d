#include "detp/validate/calibration/calibration_key.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>

using namespace detp;

TEST_SUITE("identity") {
  TEST_CASE("a key is read back from JSON as it was written") {
    const validate::CalibrationKey here = validate::this_machine();
    CHECK(validate::key_of(validate::to_json(here)) == here);
  }

  TEST_CASE("equal keys do not differ; each difference is named") {
    const validate::CalibrationKey here = validate::this_machine();
    CHECK(validate::difference(here, here).empty());
    validate::CalibrationKey other = here;
    other.threads += 1;
    CHECK(validate::difference(other, here).find("number of threads") != std::string::npos);
    other = here;
    other.instruction_set = "MMX";
    CHECK(validate::difference(other, here).find("instruction set is MMX, here it is") != std::string::npos);
    other = here;
    other.cost_model += 1;
    CHECK(validate::difference(other, here).find("cost model") != std::string::npos);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a key with a missing value is refused") {
    nlohmann::ordered_json json = validate::to_json(validate::this_machine());
    json.erase("cpu");
    CHECK_THROWS_AS(static_cast<void>(validate::key_of(json)), nlohmann::json::exception);
  }
}
