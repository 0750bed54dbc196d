#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "support/csv_answer.hpp"
#include "support/figures.hpp"
#include "support/run_support.hpp"

namespace detp::support {

TEST_SUITE("end to end") {
  TEST_CASE("powers in bands: results by name, those of a run of each band alone") {
    const support::ScratchFolder folder;
    const std::string discs = folder.file("d.csv", "x,y,z,nx,ny,nz,radius\n0,0,0,0,0,1,0.5\n5,0,0,0,0,1,0.5\n");
    std::string rows[3];
    for (int ray = 0; ray < 40; ++ray) {
      const std::string place = fmt::format("{},0,1,0,0,-1,{}", ray < 30 ? 0.01 * ray : 5.1, ray / 2);
      rows[0] += fmt::format("{},{},{}\n", place, 0.1 * ray, 3 + ray % 5);
      rows[1] += fmt::format("{},{}\n", place, 0.1 * ray);
      rows[2] += fmt::format("{},{}\n", place, 3 + ray % 5);
    }
    const std::string columns = "ox,oy,oz,dx,dy,dz,photon,";
    const std::string both = folder.file("both.csv", columns + "power_r,power_g\n" + rows[0]);
    const std::string alone[2]{folder.file("r.csv", columns + "power\n" + rows[1]),
                               folder.file("g.csv", columns + "green\n" + rows[2])};
    const auto run = [&](const std::string& rays, const std::string& more, const std::string& per_disc) {
      return detp(Arguments{"run", "--discs", discs, "--ray-file", rays, "--standard-error", "--per-disc",
                            folder.path(per_disc)} +
                  words(more + " --format json"))
          .json();
    };
    for (const char* estimator : {"disc", "variable-radius"}) {
      const std::string by = std::string("--estimator ") + estimator;
      const Json json = run(both, by, "both");
      CHECK(json.at("bands") == Json{"r", "g"});
      const Json red = run(alone[0], by, "red");
      const Json green = run(alone[1], by + " --bands g=green", "green");
      CHECK_FALSE(red.contains("bands"));
      CHECK(json.at("mean_irradiance") ==
            Json{{"r", red.at("mean_irradiance")}, {"g", green.at("mean_irradiance").at("g")}});
      const auto lines = [&](const char* name) { return figures::split(content_of(folder.path(name)), '\n'); };
      CHECK(lines("both")[0] ==
            "disc,x,y,z,nx,ny,nz,radius,vertex,hits,irradiance_r,standard_error_r,upper_bound_r,standard_error_weak_r,"
            "irradiance_g,standard_error_g,"
            "upper_bound_g,standard_error_weak_g");
      for (std::size_t line = 1; line < 3; ++line) {
        const std::string whole = lines("green")[line];
        std::string_view of_green = whole;
        for (int column = 0; column < 10; ++column) of_green.remove_prefix(of_green.find(',') + 1);
        CHECK(lines("both")[line] == fmt::format("{},{}", lines("red")[line], of_green));
      }
    }
    const Finished table = detp(Arguments{"run", "--discs", discs, "--ray-file", both, "--format", "csv"});
    CHECK(table.out.find(",mean_irradiance_r,") != std::string::npos);
    // A run until an error, which ends with the file's rays: each band as in a run of it alone.
    const std::string until = "--target-noise 1% --confidence 90%";
    const Json red = run(alone[0], until, "red");
    const Json of_red = run(both, until + " --noise-of r", "both");
    CHECK(of_red.at("noise_of") == "r");
    for (const char* key : {"noise", "noise_interval", "stopped_because"}) CHECK(of_red.at(key) == red.at(key));
    CHECK(of_red.at("mean_irradiance").at("r") == red.at("mean_irradiance"));
    const auto lines = [&](const char* name) { return figures::split(content_of(folder.path(name)), '\n'); };
    for (std::size_t line = 1; line < 3; ++line) CHECK(lines("both")[line].starts_with(lines("red")[line] + ","));
    const Json of_sum = run(both, until, "both");
    CHECK(of_sum.at("noise_of") == "all");
    CHECK(of_sum.at("noise") != of_red.at("noise"));
    CHECK(of_sum.at("mean_irradiance").at("r") == red.at("mean_irradiance"));
    const auto refused = [&](const std::string& more) { return detp(words("run " + more)).err; };
    CHECK(refused(fmt::format("--discs {} --ray-file {} --target-noise 5% --noise-of blue", discs, both))
              .find("there is no band \"blue\"; there are r, g, and all for their sum") != std::string::npos);
    CHECK(refused("@cornell --target-noise 5% --noise-of r").find("there is one without a name") != std::string::npos);
    CHECK(refused("@cornell --noise-of r").find("give --target-noise or --target-error") != std::string::npos);
  }

  TEST_CASE("light on faces adds up to that on materials, in a file and in the answer") {
    const support::ScratchFolder folder;
    const std::string file = folder.path("faces.csv");
    const Json json = result_of("run @cornell --rays 20000 --per-face " + file);
    std::map<std::string, double> light;
    double hits = 0;
    for (const CsvRow& row : csv_rows(content_of(file))) {
      light[row.at("material")] += number(row, "area") * number(row, "irradiance");
      hits += number(row, "hits");
    }
    CHECK(json["faces"]["groups"].empty());
    REQUIRE(json["faces"]["materials"].size() == light.size());
    for (const Json& material : json["faces"]["materials"]) {
      CHECK(material["light"].get<double>() == doctest::Approx(light.at(material["name"])).epsilon(1e-9));
      CHECK(material["upper_bound"].get<double>() > material["light"].get<double>());
      hits -= material["hits"].get<double>();
    }
    CHECK(hits == 0);
    CHECK(detp("run @cornell --rays 20000 --per-face " + file).out.find("faces     light on white") !=
          std::string::npos);
    const std::string rays = folder.file("r.csv", "ox,oy,oz,dx,dy,dz\n0,0,0,0,0,1\n");
    check_refused({{"run @cornell --estimator gather --per-face " + file, "gather has none"},
                   {"run @cornell --field isotropic --per-face " + file, "photons that land on a scene's triangles"},
                   {"run @uniform --samples 10 --rays 10 --per-face " + file, "needs a mesh"},
                   {"run @cornell --target-noise 5% --per-face " + file, "a run until an error does not"}});
  }

  TEST_CASE("photons of a file land in its scene as those that were traced there; a photon map gives the same light") {
    const support::ScratchFolder folder;
    const std::string rays = folder.path("rays.csv");
    REQUIRE(detp("scene @cornell --rays 5000 --write-rays " + rays).code == 0);
    const auto written = [&](const std::string& scene, const std::string& name) {
      const auto found = detp(scene + " --estimator triangle-hits --standard-error --per-disc " + folder.path(name) +
                              " --per-face " + folder.path("f" + name));
      REQUIRE_MESSAGE(found.code == 0, found.err);
      return content_of(folder.path(name)) + content_of(folder.path("f" + name));
    };
    CHECK(written("run @cornell --rays 5000", "traced.csv") == written("run @cornell --ray-file " + rays, "read.csv"));
    std::string map = "px,py,pz,wx,wy,wz,flux\n";
    double flux = 0;
    for (const CsvRow& row : csv_rows(content_of(rays))) {
      if (row.at("landing") == "inf") continue;
      const double at = number(row, "landing");
      const auto place = [&](const char* origin, const char* direction) {
        return number(row, origin) + at * number(row, direction);
      };
      map +=
          fmt::format("{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{}\n", place("ox", "dx"), place("oy", "dy"),
                      place("oz", "dz"), -number(row, "dx"), -number(row, "dy"), -number(row, "dz"), row.at("power"));
      flux += number(row, "power");
    }
    const std::string photons = folder.file("map.csv", map);
    const std::string names = " --landed --columns ox=px,oy=py,oz=pz,dx=-wx,dy=-wy,dz=-wz,power=flux";
    const Json json = result_of("run @cornell --ray-file " + photons + names + " --per-face " + folder.path("m.csv"));
    double light = 0;
    for (const Json& material : json["faces"]["materials"]) light += material["light"].get<double>();
    CHECK(light == doctest::Approx(flux).epsilon(1e-9));
    CHECK(json["inputs"]["landed"] == true);
    CHECK(json["inputs"]["columns"]["dx"] == "-wx");
    check_refused({{"run @cornell --landed", "--landed is for photons of a --ray-file"},
                   {"run @uniform --samples 10 --ray-file " + photons + names, "name one with triangles"},
                   {"run @cornell --ray-file " + rays + " --landed", "leave out length"},
                   {"run @cornell --columns ox=px", "and there is none"},
                   {"run @cornell --ray-file " + photons + " --columns o=px", "is no column of rays or discs"}});
  }

  TEST_CASE("photons in colours: ledgers, and a run until the error of a band") {
    const Json blue = result_of("run @cornell --bands rgb --samples 100 --target-error 30% --noise-of b");
    CHECK(blue.at("stopped_because") == "target");
    CHECK(blue.at("noise_interval")[1].get<double>() < 0.3);
    const Json grey = result_of("run @cornell --bands rgb --samples 100 --target-noise 30%");
    CHECK(grey.at("noise_of") == "all");
    CHECK(grey.at("noise").get<double>() != blue.at("noise").get<double>());
    CHECK(detp(words("run @cornell --bands rgb --target-error 30%")).err.find("give --noise-of one of r, g, b") !=
          std::string::npos);
    const Json rgb = result_of("run @cornell --bands rgb --rays 5000 --samples 100");
    CHECK(rgb.at("bands") == Json{"r", "g", "b"});
    CHECK(rgb.at("mean_irradiance").at("b").get<double>() < rgb.at("mean_irradiance").at("r").get<double>());
    for (const auto& [band, light] : rgb.at("light").at("bands").items())
      CHECK(std::abs(light.at("absorbed_share").get<double>() + light.at("left_share").get<double>() +
                     light.at("cut_share").get<double>() - 1) < 1e-9);
    CHECK(detp(words("run @cornell --bands rgb --field isotropic")).err.find("rgb is for photon paths") !=
          std::string::npos);
    CHECK(detp(words("run @cornell --bands r=red")).err.find("--bands names columns of --ray-file") !=
          std::string::npos);
  }
}

}  // namespace detp::support
