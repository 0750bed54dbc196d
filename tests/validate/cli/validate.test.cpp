#include <doctest/doctest.h>

#include "support/command.hpp"

namespace detp::support {

TEST_SUITE("end to end") {
  TEST_CASE("where nothing was hit, what is unknown is left out of JSON and CSV") {
    const std::string sparse = "validate --samples 1 --rays 1";
    const Finished json = detp(sparse + " --format json");
    CHECK(json.err.empty());
    CHECK((json.code == 0 || json.code == 1));
    const Json result = json.json();
    bool some_unknown = false;
    for (const Json& claim : result.at("claims"))
      if (claim.at("standard_error").is_null()) {
        some_unknown = true;
        CHECK(claim.at("detectable").is_null());
        CHECK(claim.at("verdict") == "undecided");
      }
    CHECK(some_unknown);
    for (const std::string format : {"csv", "text"})
      CHECK_FALSE(has_no_number(detp(sparse + " --format " + format).out));
  }

  TEST_CASE("the sweep's options are refused where there is no sweep") {
    check_refused({{"validate --resume", "--effort thorough"},
                   {"validate --checkpoint x.json", "--effort thorough"},
                   {"validate --most-samples 1000", "--effort thorough"},
                   {"validate --effort thorough --resume", "--checkpoint"},
                   {"validate @tree --effort thorough", "takes no scene"},
                   {"validate --effort thorough --most-samples 0", "--most-samples"},
                   {"validate --effort great", "default,thorough"}});
  }

  TEST_CASE("a time limit before the first verdict ends with code 3 and what there is") {
    const Finished finished = detp("validate --time-limit 0.2 --format json");
    CHECK(finished.code == 3);
    CHECK(finished.err.empty());
    CHECK(finished.json().at("stopped") == true);
    CHECK(finished.json().at("claims").is_array());
    CHECK(finished.seconds < 5);
  }
}

}  // namespace detp::support
