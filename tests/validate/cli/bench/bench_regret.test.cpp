#include <doctest/doctest.h>

#include "support/command.hpp"

namespace detp::support {

TEST_SUITE("end to end") {
  TEST_CASE("bench --regret that is stopped shows its results so far and ends with code 3") {
    const Finished finished = detp("bench --regret --time-limit 0.2 --format json");
    CHECK(finished.code == 3);
    CHECK(finished.err.empty());
    CHECK(finished.json().at("stopped") == true);
    CHECK(finished.json().at("stopped_after").at("unit") == "workloads");
    CHECK(finished.json().at("inputs").at("regret") == true);
  }

  TEST_CASE("bench --regret refuses what it cannot run, with the reason") {
    check_refused({{"bench --regret nowhere", "@courtyard"},
                   {"bench --regret @uniform --field photons", "photons"},
                   {"bench --regret --effort great", "great"},
                   {"bench --regret --rays 100", "--regret"},
                   {"bench --regret --samples 100", "--regret"},
                   {"bench --regret --disc-radius 1%", "--regret"},
                   {"bench --regret --techniques grid", "--regret"},
                   {"bench --regret --embree-modes all", "--regret"},
                   {"bench --regret --repeat 3", "--regret"},
                   {"bench --regret --most-hits 1e5", "--regret"},
                   {"bench --regret --costs t=x", "t"},
                   {"bench --regret --calibration missing.json", "missing.json"},
                   {"bench @tree --costs t=x", "t"},
                   {"bench @tree --calibration missing.json", "missing.json"}});
  }
}

TEST_SUITE("long") {
  TEST_CASE("bench --regret on one scene has its workloads and their figures") {
    const Json json = result_of("bench --regret @uniform --threads 2 --calibration none");
    CHECK(json.at("inputs").at("scenes") == Json{"@uniform"});
    const std::size_t workloads = json.at("inputs").at("workloads");
    CHECK(json.at("rows").size() == json.at("summary").at("tiers").size() * workloads);
    for (const Json& row : json.at("rows")) {
      CHECK(row.at("scene") == "@uniform");
      CHECK(row.at("threads") == 2);
      CHECK(row.at("held_out") == false);
    }
    const Json& summary = json.at("summary");
    CHECK(summary.at("threads") == 2);
    CHECK(summary.at("regret").at("estimate").at("fitted").at("workloads") == workloads);
    CHECK(summary.at("regret").at("estimate").at("held_out").at("geometric_mean").is_null());
    CHECK(json.at("unit_costs").get<std::string>().find("built in") != std::string::npos);
  }
}

}  // namespace detp::support
