#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "support/csv_answer.hpp"
#include "support/run_support.hpp"

namespace detp::support {

TEST_SUITE("end to end") {
  TEST_CASE(
      "a run of many photon paths that is stopped has the irradiance by those that were searched, and its error") {
    const ScratchFolder folder;
    const std::string file = folder.path("irradiance.csv");
    const std::string line = "run @cornell --threads 2 --technique box-tree --leaf 8 --fan-out 8 --rays ";
    const Finished stopped = detp(line + "1e9 --time-limit 1.5 --standard-error --format json --per-disc " + file);
    REQUIRE(stopped.code == 3);
    const Json json = stopped.json();
    const Json all = result_of(line + "2e6");
    const double error = json["mean_irradiance_error"];
    CHECK(error > 0);
    CHECK(error < 0.01 * json["mean_irradiance"].get<double>());
    const double allowed = 5 * error * std::sqrt(1 + json["rays"].get<double>() / 2e6);
    CHECK(std::abs(json["mean_irradiance"].get<double>() - all["mean_irradiance"].get<double>()) < allowed);
    CHECK(json["stopped_after"]["of"] == 1'000'000'000);
    CHECK(json["stopped_after"]["done"] == json["rays"]);
    CHECK(json["rays"] > 10'000);
    CHECK(json["light"]["photons"] == json["photons"]);
    CHECK(all["light"]["photons"] == all["photons"]);
    CHECK(all["rays"] >= 2'000'000);
    const std::vector<CsvRow> rows = csv_rows(content_of(file));
    CHECK(rows.size() == json["inputs"]["samples"].get<std::size_t>());
    double irradiance = 0;
    double hits = 0;
    for (const CsvRow& row : rows) {
      hits += std::stod(row.at("hits"));
      irradiance += std::stod(row.at("irradiance"));
    }
    CHECK(hits == json["hits_so_far"]);
    CHECK(irradiance / static_cast<double>(rows.size()) == doctest::Approx(json["mean_irradiance"].get<double>()));
    // Lines are no photons: a sum over the first of them is too small.
    const std::string none = folder.path("lines.csv");
    const Finished lines =
        detp("run @cornell --field isotropic --rays 1e9 --time-limit 0.5 --format json --per-disc " + none);
    INFO(lines.err);
    REQUIRE(lines.code == 3);
    CHECK_FALSE(std::filesystem::exists(none));
    const Json some = result_of("run @cornell --field isotropic --rays 3e6");
    CHECK(lines.json()["mean_irradiance"].get<double>() / 1e9 ==
          doctest::Approx(some["mean_irradiance"].get<double>() / 3e6).epsilon(0.02));
  }
}

}  // namespace detp::support
