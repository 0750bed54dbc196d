#include "detp/validate/whole/whole.hpp"

#include <doctest/doctest.h>

#include "support/attempts.hpp"
#include "support/machine.hpp"
#include "support/run_support.hpp"

using namespace detp;
using namespace detp::support;
using validate::WholeInputs;

TEST_SUITE("limit") {
  TEST_CASE("every part of the wait grows with what it depends on, and with nothing else") {
    const WholeInputs some{.triangles = 1e4, .discs = 5000, .rays = 1e6, .rays_in_memory = 1e6, .traced = true};
    const CostBreakdown search{.order = 0.01, .build = 0.02, .intersect = 0.5};
    const auto seconds = validate::whole_seconds(some, search, 0, 1);
    CHECK(seconds.prepare == doctest::Approx(0.03));
    CHECK(seconds.search == doctest::Approx(0.5));
    CHECK(seconds.total() > seconds.read + seconds.trace + 0.53);
    const auto with = [&](auto change) {
      WholeInputs other = some;
      change(other);
      return validate::whole_seconds(other, search, 0, 1);
    };
    CHECK(with([](auto& one) { one.text_bytes = 1e9; }).read > seconds.read + 1);
    CHECK(with([](auto& one) { one.triangles *= 2; }).read > 1.5 * seconds.read);
    CHECK(with([](auto& one) { one.rays *= 2; }).trace > 1.8 * seconds.trace);
    CHECK(with([](auto& one) { one.traced = false; }).trace < 0.2 * seconds.trace);
    CHECK(with([](auto& one) { one.from_file = true; }).trace == 0);
    CHECK(validate::whole_seconds(some, search, 1e6, 1).prepare > 0.1);
    CHECK(validate::peak_bytes(some, 1e6) > 84e6);
    WholeInputs streamed = some;
    streamed.rays = 1e9;
    streamed.rays_in_memory = 0x1p18;
    CHECK(validate::peak_bytes(streamed, 1e6) < 2e8);
    CHECK(validate::peak_bytes(streamed, 2e6) == doctest::Approx(validate::peak_bytes(streamed, 1e6) + 1e6));
  }
}

TEST_SUITE("end to end") {
  TEST_CASE("a run predicts its whole wait and its memory, and measures both; choose says the same" *
            doctest::test_suite("long")) {
    for (const std::string line :
         {"@cornell --rays 1e5", "@cornell --rays 2e6", "@terrain:7 --rays 1e4", "@uniform --samples 1e4 --rays 1e6",
          "@cornell --rays 3e5 --estimator triangle-hits", "@cornell --rays 3e5 --estimator variable-radius",
          "@cornell --rays 1e5 --estimator nearest --nearest 50"}) {
      CAPTURE(line);
      CHECK(in_attempts(5, [&] {
        const Json json = result_of("run " + line);
        const Json& whole = json["whole"];
        const Json& measured = json["whole_measured"];
        for (const char* part : {"read", "trace", "prepare", "search", "total"}) {
          CHECK(whole[part] >= 0);
          CHECK(measured[part] >= 0);
        }
        CHECK(json["peak_bytes"] > 1e7);
        CHECK(json["peak_bytes_measured"] > 1e7);
        const double ratio = whole["total"].get<double>() / measured["total"].get<double>();
        const double memory = json["peak_bytes"].get<double>() / json["peak_bytes_measured"].get<double>();
        // other programs may take most of the processor meanwhile
        return sanitized || (ratio > 0.25 && ratio < 4 && memory > 0.7 && memory < 1.4);
      }));
      if (line.find("--estimator") != std::string::npos) continue;
      const Json chosen = result_of("choose " + line);
      CHECK(chosen["whole"]["total"] > chosen["choice"]["predicted_seconds"]);
      CHECK(chosen["peak_bytes"] > 1e7);
    }
    // the rays of backward paths are not known before
    CHECK(result_of("run @cornell --estimator gather --paths 2")["whole"].is_null());
    CHECK(result_of("run @cornell --rays 1e4 --seeds 1:2")["rows"][0]["whole_measured"].is_null());
    CHECK(support::detp("run @cornell --rays 1e4").out.find("\nwhole ") != std::string::npos);
    const Json accuracy = result_of("accuracy @cornell --target-noise 10%");
    CHECK(accuracy["whole"]["total"] > accuracy["answer"]["predicted_seconds"]);
    CHECK(accuracy["peak_bytes"] > 1e7);
  }
}
