#include <doctest/doctest.h>

#include "support/command.hpp"

namespace detp::support {
namespace {

/// Ten thousand million tests: more than ten seconds.
const std::string long_run = "run @uniform --samples 100000 --rays 100000 --technique brute-force --format json ";

void check_stopped(const Finished& finished) {
  CAPTURE(finished.err);
  CHECK(finished.signal == 0);
  CHECK(finished.code == 3);
  CHECK(finished.err.empty());
  const Json json = finished.json();
  CHECK(json.at("stopped") == true);
  CHECK(json.at("counts").at("disc_tests").get<double>() < 1e10);
  CHECK(finished.seconds < 5);
}

Finished interrupted_by(int signal) {
  Process process(words(long_run));
  std::this_thread::sleep_for(std::chrono::seconds(1));
  process.send(signal);
  return process.finish();
}

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("Ctrl-C or a termination signal stops a run, which shows what it has and ends with code 3") {
    check_stopped(interrupted_by(SIGINT));
    check_stopped(interrupted_by(SIGTERM));
  }

  TEST_CASE("a time limit stops a run, which shows what it has and ends with code 3") {
    check_stopped(detp(long_run + "--time-limit 0.5"));
    CHECK(detp("run @uniform --samples 100 --rays 100 --time-limit 30").code == 0);
  }
}

}  // namespace detp::support
