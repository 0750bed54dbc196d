#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "support/csv_answer.hpp"
#include "support/run_support.hpp"

namespace detp::support {

TEST_SUITE("run until") {
  TEST_CASE("a noise is reached with its interval, and says why the run ended; the bytes do not depend on threads") {
    const ScratchFolder folder;
    const std::string one = folder.path("one.csv");
    const std::string two = folder.path("two.csv");
    const std::string command = "run @cornell --target-noise 20% --technique box-tree --calibration none --per-disc ";
    const Json json = result_of(command + one + " --threads 1");
    CHECK(json["stopped_because"] == "target");
    CHECK(json["stopped"] == false);
    CHECK(json["noise_interval"][1].get<double>() <= 0.2);
    CHECK(json["noise"].get<double>() <= json["noise_interval"][1].get<double>());
    CHECK(json["error"] == json["noise"]);
    CHECK(json["bias_estimate"].is_null());  // that nobody asked for
    CHECK(json["confidence"] == 0.95);
    CHECK(json["photons"].get<double>() < json["rays"].get<double>());
    CHECK(json["inputs"]["target_noise"] == 0.2);
    CHECK(json["inputs"]["target_error"].is_null());
    const Json again = result_of(command + two + " --threads 2");
    CHECK(again["noise"] == json["noise"]);
    CHECK(content_of(two) == content_of(one));
  }

  TEST_CASE("standard errors beside a noise: wherever two photons hit, and together as large as the noise" *
            doctest::test_suite("long")) {
    const ScratchFolder folder;
    const std::string file = folder.path("discs.csv");
    const std::string command =
        "run @cornell --target-noise 15% --calibration none --standard-error --per-disc " + file + " --threads ";
    const Json json = result_of(command + "1");
    const std::string one = content_of(file);
    CHECK(result_of(command + "2")["noise"] == json["noise"]);
    CHECK(content_of(file) == one);
    double squares = 0;
    double variances = 0;
    std::istringstream lines(one);
    std::string line;
    REQUIRE(std::getline(lines, line));
    REQUIRE(line == "disc,x,y,z,nx,ny,nz,radius,vertex,hits,irradiance,standard_error,upper_bound,standard_error_weak");
    for (const CsvRow& row : csv_rows(one)) {
      const double irradiance = number(row, "irradiance");
      const bool known = !row.at("standard_error").empty();
      if (number(row, "hits") > 2) REQUIRE(known);  // two hits may be of one photon
      const double error = known ? number(row, "standard_error") : 0;
      squares += irradiance * irradiance - error * error;
      variances += error * error;
    }
    // weighted equally here, and by area there
    CHECK(std::sqrt(variances / squares) == doctest::Approx(json["noise"].get<double>()).epsilon(0.1));
  }

  TEST_CASE("lines, a workload of numbers, and rays of a file run until a noise, too; they have no bias") {
    for (const char* problem : {"@cornell --field isotropic", "--samples 300 --scene-side 4 --disc-radius 0.2"}) {
      CAPTURE(problem);
      const Json json = result_of(std::string("run ") + problem + " --target-noise 10% --calibration none");
      CHECK(json["stopped_because"] == "target");
      CHECK(json["bias_estimate"].is_null());
      CHECK(json["photons"].get<double>() == json["rays"].get<double>());
      CHECK(json["error"] == json["noise"]);
    }
    const ScratchFolder folder;
    const std::string rays = folder.path("rays.csv");
    CHECK(detp("scene @cornell --rays 20000 --write-rays " + rays).code == 0);
    const Finished few = detp("run @cornell --ray-file " + rays + " --target-noise 5% --format json");
    CHECK(few.code == 3);
    const Json json = Json::parse(few.out);
    CHECK(json["stopped_because"] == "rays");
    CHECK(json["hits"] == result_of("run @cornell --ray-file " + rays)["hits"]);
  }

  TEST_CASE("the order of a file's rays does not matter: photons of two lights, one after the other") {
    const ScratchFolder folder;
    const std::string discs = folder.path("discs.csv");
    std::ofstream(discs) << "x,y,z,nx,ny,nz,radius\n0.25,0.5,0,0,0,1,0.1\n0.75,0.5,0,0,0,1,0.1\n";
    const std::string rays = folder.path("rays.csv");
    std::ofstream file(rays);
    file << "ox,oy,oz,dx,dy,dz,length,power\n";
    constexpr int photons = 100'000;
    for (int i = 0; i < 2 * photons; ++i) {
      const double u = std::fmod(i * 0.6180339887498949, 1.0);
      const double v = std::fmod(i * 0.7548776662466927, 1.0);
      file << 0.5 * u + (i < photons ? 0 : 0.5) << ',' << v << ",1,0,0,-1,1.1," << 0.5 / photons << '\n';
    }
    file.close();
    const std::string found = folder.path("found.csv");
    const Json json =
        result_of("run --discs " + discs + " --ray-file " + rays + " --target-noise 5% --per-disc " + found);
    CHECK(json["stopped_because"] == "target");
    CHECK(json["rays"].get<double>() < 2 * photons);
    for (const CsvRow& row : csv_rows(content_of(found)))
      CHECK(number(row, "irradiance") == doctest::Approx(1).epsilon(0.1));
    const Finished text = detp("run --discs " + discs + " --ray-file " + rays + " --target-noise 5%");
    CHECK(text.code == 0);
    CHECK(text.out.find("first stage") == std::string::npos);
  }

  TEST_CASE("an error below the bias is not reached, with exit code 3 and a smaller radius if there is one" *
            doctest::test_suite("long")) {
    const Finished found = detp("run @furnace --target-error 3% --format json");
    CHECK(found.code == 3);
    const Json json = Json::parse(found.out);
    CHECK(json["stopped_because"] == "bias");
    CHECK(json["error"].get<double>() > 0.03);
    const Finished text = detp("run @furnace --target-error 3% --quiet");
    CHECK(text.out.find("the bias alone is as large") != std::string::npos);
    const Json reached = result_of("run @furnace --target-error 10% --estimator triangle-hits");
    CHECK(reached["error"].get<double>() <= 0.1);
  }

  TEST_CASE("a time limit ends the run with what is known") {
    const Finished found = stopped_in_time("run @cornell --target-noise 0.1% --format json", [](const Finished& one) {
      return one.json().contains("noise") && one.json()["noise"].is_number();
    });
    CHECK(found.code == 3);
    const Json json = found.json();
    CHECK(json.at("stopped") == true);
    CHECK(json.at("stopped_because") == "time");
    CHECK(json.at("noise").get<double>() > 0.001);
  }

  TEST_CASE("each seed makes a row") {
    const auto rows = csv_of("run @cornell --target-noise 30% --seeds 1:3 --calibration none");
    REQUIRE(rows.size() == 3);
    for (const CsvRow& row : rows) {
      CHECK(row.at("stopped_because") == "target");
      CHECK(number(row, "noise_high") <= 0.3);
    }
    CHECK(rows[0].at("noise") != rows[1].at("noise"));
  }

  TEST_CASE("what does not go together is refused") {
    check_refused({{"run @cornell --target-noise 5% --target-error 5%", "--target-noise"},
                   {"run @cornell --target-noise 0", "target error"},
                   {"run @cornell --target-noise 5% --confidence 1", "confidence"},
                   {"run @cornell --target-noise 5% --estimator nearest", "nearest needs all its rays"},
                   {"run @cornell --target-noise 5% --estimator variable-radius", "variable-radius needs all its rays"},
                   {"run @cornell --target-noise 5% --repeat 3", "--repeat"}});
  }
}

TEST_SUITE("end to end") {
  TEST_CASE("a run of many photon paths that is stopped has the irradiance by those that were searched, and its error" *
            doctest::test_suite("long")) {
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
