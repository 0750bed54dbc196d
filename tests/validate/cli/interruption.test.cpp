#include <doctest/doctest.h>

#include "support/command.hpp"

namespace detp::support {
namespace {

/// Ten thousand million tests on one thread: more than ten seconds.
const std::string long_run =
    "run @uniform --samples 100000 --rays 100000 --technique brute-force --threads 1 --format json ";

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

double shortest_of_ten(const std::string& line) {
  double shortest = 1e9;
  for (int i = 0; i < 10; ++i) shortest = std::min(shortest, detp(line).seconds);
  return shortest;
}

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("Ctrl-C or a termination signal stops a run, which shows what it has and ends with code 3") {
    check_stopped(interrupted_by(SIGINT));
    check_stopped(interrupted_by(SIGTERM));
  }

  TEST_CASE("a stopped run leaves no partial file behind") {
    const sim::support::ScratchFolder folder;
    const Finished finished = detp(long_run + "--time-limit 0.5 --per-disc " + folder.path("discs.csv") + " --pairs " +
                                   folder.path("pairs.csv"));
    CHECK(finished.code == 3);
    CHECK(finished.err.find("not written") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(folder.path("discs.csv")));
    CHECK_FALSE(std::filesystem::exists(folder.path("pairs.csv")));
  }

  TEST_CASE("watching for signals keeps no finished command waiting") {
    CHECK(shortest_of_ten("model --samples 10 --disc-radius 0.1 --scene-side 1") <
          shortest_of_ten("--version") + 0.025);
  }

  TEST_CASE("a time limit stops a run, which shows what it has and ends with code 3") {
    check_stopped(detp(long_run + "--time-limit 0.5"));
    CHECK(detp("run @uniform --samples 100 --rays 100 --time-limit 30").code == 0);
  }
}

}  // namespace detp::support
