#include <doctest/doctest.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <tuple>

#include "support/attempts.hpp"
#include "support/csv_answer.hpp"
#include "support/figures.hpp"
#include "support/run_support.hpp"

namespace detp::support {
namespace {

/// The definition of a hit (validate/cli/README.md), coded as simply as possible.
bool crosses(const sim::Ray& ray, const sim::Disc& disc, bool front_facing) {
  const double slope = glm::dot(ray.direction, disc.normal);
  if (slope == 0 || (front_facing && slope > 0)) return false;
  const double way = glm::dot(disc.centre - ray.origin, disc.normal) / slope;
  if (std::isfinite(ray.length) && !(way >= 0 && way <= ray.length)) return false;
  return glm::length(ray.origin + way * ray.direction - disc.centre) <= disc.radius;
}

struct OwnData {
  ScratchFolder folder;
  std::vector<sim::Disc> discs = mixed_discs(300);
  std::vector<sim::Ray> rays = mixed_rays(800);
  Arguments csv{"run", "--discs", folder.path("discs.csv"), "--ray-file", folder.path("rays.csv")};
  Arguments ply{"run", "--discs", folder.path("discs.ply"), "--ray-file", folder.path("rays.ply")};

  OwnData() {
    sim::write_discs(csv[2], discs);
    sim::write_rays(csv[4], rays);
    to_ply("discs");
    to_ply("rays");
  }

  void to_ply(const std::string& name) const {
    const std::string table = support::content_of(folder.path(name + ".csv"));
    const std::vector<std::string> rows = rows_of(table);
    std::string text = fmt::format("ply\nformat ascii 1.0\nelement vertex {}\n", rows.size());
    std::istringstream header(table.substr(0, table.find('\n')));
    for (std::string column; std::getline(header, column, ',');) text += "property double " + column + "\n";
    text += "end_header\n";
    for (std::string row : rows) {
      std::replace(row.begin(), row.end(), ',', ' ');
      text += row + "\n";
    }
    folder.file(name + ".ply", text);
  }

  [[nodiscard]] std::string expected_pairs(bool front_facing) const {
    std::string text = "ray,disc\n";
    for (std::size_t ray = 0; ray < rays.size(); ++ray)
      for (std::size_t disc = 0; disc < discs.size(); ++disc)
        if (crosses(rays[ray], discs[disc], front_facing)) text += fmt::format("{},{}\n", ray, disc);
    return text;
  }
};

std::vector<std::string> sorted_rows(const std::string& csv) {
  std::vector<std::string> rows = rows_of(csv);
  std::sort(rows.begin(), rows.end());
  return rows;
}

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("--form changes the prediction and not the counts: the published one is that of model at the run's k") {
    const std::string numbers = " --rays 5000 --samples 4000 --disc-radius 0.02 --scene-side 2 --technique ";
    const auto ask = [&](const std::string& rest) { return result_of("run" + numbers + rest); };
    const Json published = ask("sphere-cache --ratio 0.65 --form published");
    const Json corrected = ask("sphere-cache --ratio 0.65 --form corrected");
    CHECK(published.at("counts") == corrected.at("counts"));
    CHECK(published.at("inputs").at("form") == "published");
    CHECK(published.at("whole").at("search") ==
          corrected.at("whole").at("search"));  // the wait is that of the better form
    CHECK(corrected.at("predicted") == ask("sphere-cache --ratio 0.65").at("predicted"));
    const Json model = result_of("model" + numbers + "sphere-cache --ratio 0.65 --form published --spheres " +
                                 published.at("k").dump());
    for (const char* term : {"cull_tests", "disc_tests", "culls"})
      CHECK(published.at("predicted").at(term) == model.at("counts").at(term));
    const Json octree = ask("octree --depth 3 --form published");
    CHECK(octree.at("predicted").at("disc_tests") == 5000.0 * 4000 / 64);
    CHECK(octree.at("predicted").at("nodes") == 5000.0 * 8);
    const std::string text = detp("run" + numbers + "sphere-cache --ratio 0.65 --form published").out;
    CHECK(text.find("\nformulas  published, in tests: T_R ") != std::string::npos);
    CHECK(text.find(" spheres can hold a disc, which detp model takes: --spheres ") != std::string::npos);
    CHECK(detp("run @cornell --rays 2000 --technique grid").out.find("formulas") == std::string::npos);
    check_refused({{"run @cornell --form published", "give --technique"},
                   {"run @cornell --technique grid --form published", "the paper has no formulas for grid"},
                   {"run @cornell --technique octree --form published --target-noise 5%", "a run until an error"}});
  }

  TEST_CASE("own discs and rays: brute force finds the hits of the definition, in input order") {
    const OwnData data;
    for (const bool front_facing : {false, true}) {
      const Written written =
          run_and_read(data.csv, front_facing ? "--technique brute-force --front-facing" : "--technique brute-force");
      CHECK(written.pairs == data.expected_pairs(front_facing));
      const std::vector<CsvRow> rows = csv_rows(written.per_disc);
      REQUIRE(rows.size() == data.discs.size());
      for (std::size_t i = 0; i < rows.size(); ++i) {
        std::uint64_t hits = 0;
        double power = 0;
        for (const sim::Ray& ray : data.rays)
          if (crosses(ray, data.discs[i], front_facing)) {
            ++hits;
            power += ray.power;
          }
        const auto& [centre, normal, radius] = data.discs[i];
        CHECK(rows[i].at("disc") == std::to_string(i));
        CHECK(number(rows[i], "hits") == static_cast<double>(hits));
        CHECK(number(rows[i], "irradiance") ==
              doctest::Approx(power / (std::numbers::pi * radius * radius)).epsilon(1e-12));
        CHECK(glm::dvec3(number(rows[i], "x"), number(rows[i], "y"), number(rows[i], "z")) == centre);
        CHECK(number(rows[i], "nz") == doctest::Approx(normal.z));
        CHECK(number(rows[i], "radius") == radius);
        CHECK(rows[i].at("vertex") == "-1");
      }
    }
  }

  TEST_CASE("--standard-error adds three columns, and changes no other") {
    const ScratchFolder folder;
    const auto written = [&](const std::string& more) {
      const std::string path = folder.path("discs.csv");
      CHECK(detp("run @uniform --samples 40 --rays 3000 --disc-radius 5% --per-disc " + path + more).code == 0);
      return support::content_of(path);
    };
    const std::string with = written(" --standard-error");
    CHECK(with.starts_with(
        "disc,x,y,z,nx,ny,nz,radius,vertex,hits,irradiance,standard_error,upper_bound,standard_error_weak\n"));
    std::string without;
    for (const std::string& row : rows_of(with)) {
      const auto from_end = row.rfind(',', row.rfind(',', row.rfind(',') - 1) - 1);
      without += row.substr(0, from_end) + "\n";
    }
    int errors = 0;
    for (const CsvRow& row : csv_rows(with)) {
      const double hits = number(row, "hits");
      const double irradiance = number(row, "irradiance");
      // All lines carry the same power.
      const double expected = irradiance * std::sqrt((1 - hits / 3000) / hits * 3000 / 2999);
      if (hits >= 2)
        CHECK(number(row, "standard_error") == doctest::Approx(expected));
      else
        CHECK(row.at("standard_error").empty());
      CHECK(row.at("standard_error_weak") == (hits >= 10 ? "0" : "1"));
      if (hits >= 10)
        CHECK(row.at("upper_bound").empty());
      else
        CHECK(number(row, "upper_bound") > irradiance);
      errors += hits >= 10 ? 1 : 0;
    }
    CHECK(errors > 0);
    CHECK(errors < 40);
    CHECK("disc,x,y,z,nx,ny,nz,radius,vertex,hits,irradiance\n" + without == written(""));
  }

  TEST_CASE("photons of a ray file: their rays may be apart, pairs have the file's numbers, errors are of photons") {
    const ScratchFolder folder;
    const std::string discs = folder.file("discs.csv", "x,y,z,nx,ny,nz,radius\n0,0,0,0,0,1,1\n");
    std::string together = "ox,oy,oz,dx,dy,dz,photon\n";
    std::string apart = together;
    std::string anonymous = "ox,oy,oz,dx,dy,dz\n";
    for (int photon = 0; photon < 24; ++photon)
      for (int i = 0; i < 2; ++i) {
        const std::string ray = fmt::format("{},0,0,0,0,1", photon % 2 == 0 ? 0.1 : 5.0);
        together += fmt::format("{},{}\n", ray, photon);
        anonymous += ray + "\n";
      }
    for (int i = 0; i < 2; ++i)
      for (int photon = 0; photon < 24; ++photon)
        apart += fmt::format("{},0,0,0,0,1,{}\n", photon % 2 == 0 ? 0.1 : 5.0, photon);
    const auto result = [&](const std::string& rays) {
      const std::string per_disc = folder.path("out.csv");
      const std::string pairs = folder.path("pairs.csv");
      const auto run = detp("run --discs " + discs + " --ray-file " + folder.file("rays.csv", rays) + " --per-disc " +
                            per_disc + " --standard-error --pairs " + pairs + " --format json");
      REQUIRE(run.code == 0);
      return std::tuple{support::content_of(per_disc), support::content_of(pairs), Json::parse(run.out), run.err};
    };
    const auto [errors, pairs, json, err] = result(together);
    // 12 of 24 photons hit, each with two rays.
    CHECK(number(csv_rows(errors).front(), "standard_error") ==
          doctest::Approx(2 * std::sqrt(24 * 0.25 * 24 / 23.0) / std::numbers::pi));
    CHECK(json["photons"] == 24);
    CHECK(json["rays"] == 48);
    CHECK(err.find("photon") == std::string::npos);
    const auto [errors_apart, pairs_apart, json_apart, err_apart] = result(apart);
    CHECK(errors_apart == errors);
    CHECK(rows_of(pairs_apart)[1] == "2,0");
    CHECK(rows_of(pairs_apart).back() == "46,0");
    const auto [errors_of_rays, pairs_of_rays, json_of_rays, err_of_rays] = result(anonymous);
    CHECK(errors_of_rays != errors);
    CHECK(json_of_rays["photons"] == 48);
    CHECK(err_of_rays.find("each ray counts as a photon of its own") != std::string::npos);
  }

  TEST_CASE("own discs and rays: every technique writes the bytes that brute force writes") {
    const OwnData data;
    const Written both = check_all_agree(data.csv);
    const Written front = check_all_agree(data.csv + words("--front-facing"), best_techniques());
    CHECK(front.hits < both.hits);
    CHECK(front.hits > 0);
    CHECK(rows_of(both.pairs).size() == both.hits);
  }

  TEST_CASE("discs all in one point: no sphere pays off, so the sphere cache runs without one") {
    const ScratchFolder folder;
    const std::string discs = folder.file("discs.csv", "x,y,z,nx,ny,nz,radius\n0,0,0,0,0,1,0.5\n0,0,0,0,1,0,0.5\n");
    const std::string rays = folder.file("rays.csv", "ox,oy,oz,dx,dy,dz\n0.1,0.1,0,0,0,1\n5,5,5,0,0,1\n");
    for (const std::string technique : {"sphere-cache", "sphere-cache-published", "sphere-cache --ratio 0.5"}) {
      const Json json = result_of("run --discs " + discs + " --ray-file " + rays + " --technique " + technique);
      CHECK(json.at("hits") == 1);
      CHECK(json.at("parameters").at("spheres") == 0);
    }
  }

  TEST_CASE("PLY files give the same results as CSV files") {
    const OwnData data;
    CHECK(run_and_read(data.ply, "--technique brute-force") == run_and_read(data.csv, "--technique brute-force"));
    CHECK(run_and_read(data.ply, "--technique octree") == run_and_read(data.csv, "--technique grid"));
  }

  TEST_CASE("lines and photon paths: every technique writes the bytes that brute force writes" *
            doctest::test_suite("long")) {
    check_all_agree(words("run @uniform --samples 2000 --rays 2000"), best_techniques());
    check_all_agree(words("run @cornell --rays 3000"), best_techniques());
    check_all_agree(words("run @cornell --rays 2000 --front-facing --disc-radius 8% --samples 1500"),
                    best_techniques());
    check_all_agree(words("run @cornell --rays 1000 --field isotropic --samples 2000"), best_techniques());
    check_all_agree(words("run --samples 1000 --rays 1000 --disc-radius 5% --scene-side 3 --dimension 2"),
                    best_techniques());
  }

  TEST_CASE("the published sphere cache loses hits and adds none") {
    const OwnData data;
    for (const Arguments& problem : {data.csv, words("run @uniform --samples 3000 --rays 2000")}) {
      CAPTURE(line_of(problem));
      const auto all = sorted_rows(run_and_read(problem, "--technique brute-force").pairs);
      const auto kept =
          sorted_rows(run_and_read(problem, "--technique sphere-cache-published --ratio 0.65 --spheres 4").pairs);
      CHECK(kept.size() < all.size());
      CHECK(kept.size() > all.size() / 10);
      CHECK(std::includes(all.begin(), all.end(), kept.begin(), kept.end()));
    }
  }

  TEST_CASE("--seeds makes a row for each seed, as a run with --seed") {
    const Json table = result_of("run @uniform --samples 200 --rays 500 --disc-radius 5% --seeds 4:6,9");
    REQUIRE(table["rows"].size() == 4);
    const std::vector<int> seeds{4, 5, 6, 9};
    CHECK(table["inputs"]["seed"] == seeds);
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      const Json one =
          result_of("run @uniform --samples 200 --rays 500 --disc-radius 5% --seed " + std::to_string(seeds[i]));
      CHECK(table["rows"][i]["hits"] == one["hits"]);
    }
    check_refused({{"run @uniform --seeds 6:4", "--seeds"},
                   {"run @uniform --seeds -1:3", "--seeds"},
                   {"run @uniform --seeds 1:9999999", "rows"}});
  }

  TEST_CASE("CSV is one row with the values of JSON, and text has the same number of hits") {
    const std::string run = "run @cornell --rays 2000 --technique sphere-cache --ratio 0.5";
    const Json json = result_of(run);
    const auto rows = csv_of(run);
    REQUIRE(rows.size() == 1);
    const CsvRow& row = rows[0];
    CHECK(row.at("scene") == "@cornell");
    CHECK(row.at("field") == "photons");
    CHECK(row.at("technique") == "sphere-cache");
    CHECK(row.at("ratio") == "0.5");
    CHECK(row.at("engine") == "simd");
    CHECK(row.at("stopped") == "false");
    CHECK(row.at("depth").empty());
    for (const auto& [term, count] : json.at("counts").items()) CHECK(row.at(term) == count.dump());
    for (const auto& [term, count] : json.at("predicted").items())
      CHECK(number(row, "predicted_" + term) == count.get<double>());
    CHECK(number(row, "mean_irradiance") == json.at("mean_irradiance").get<double>());
    CHECK(number(row, "seconds") > 0);
    for (const Json& effect : json.at("effects")) {
      std::string column = effect.at("name");
      std::replace(column.begin(), column.end(), ' ', '_');
      CHECK(row.at(column) == effect.at("on").dump());
      CHECK_FALSE(effect.at("reason").get<std::string>().empty());
    }
    const std::string hits = fmt::format("hits      {},", json.at("hits").get<int>());
    const std::string text = detp(run).out;
    CHECK(text.find(hits) != std::string::npos);
    CHECK(text.find("effects") == std::string::npos);
    CHECK(std::ranges::count(text, '\n') <= 6);
    const std::string more = detp(run + " --verbose").out;
    CHECK(more.find(hits) != std::string::npos);
    CHECK(more.find("effects   on: ") != std::string::npos);
    CHECK(more.find("predicted / counted") != std::string::npos);
  }

  TEST_CASE("the plain engine finds the hits of the float kernels, and the result names it" *
            doctest::test_suite("long")) {
    for (const std::string technique :
         {"brute-force", "sphere-cache --ratio 0.6", "cell-spheres --depth 3", "sphere-tree --fan-out 4 --leaf 16"}) {
      CAPTURE(technique);
      const Arguments run = words("run @cornell --rays 2000 --technique " + technique);
      const Written simd = run_and_read(run, "--engine simd");
      const Written plain = run_and_read(run, "--engine plain");
      CHECK(plain == simd);
      CHECK(plain.json.at("inputs").at("engine") == "plain");
      CHECK(simd.json.at("inputs").at("engine") == "simd");
      CHECK(plain.json.at("seconds").at("search").get<double>() > 0);
    }
    // Lists of the plain engine hold exactly the rays that cross the spheres, lists of the simd engine a few more.
    const std::string cache =
        "run @uniform --samples 2000 --rays 20000 --technique sphere-cache --ratio 0.6 --spheres 6";
    const Json plain = result_of(cache + " --engine plain").at("counts");
    const Json simd = result_of(cache).at("counts");
    CHECK(plain.at("hits") == simd.at("hits"));
    CHECK(plain.at("disc_tests").get<double>() < simd.at("disc_tests").get<double>());
  }

  TEST_CASE("a sphere cache runs with the best stop by default, and reports the form's own too") {
    const std::string line = "run @uniform --samples 2000 --rays 2000 --technique sphere-cache --ratio 0.7";
    const Json best = result_of(line);
    const Json max = result_of(line + " --spheres max");
    CHECK(best.at("k") == best.at("k_best"));
    CHECK(best.at("k") == best.at("parameters").at("spheres"));
    CHECK(best.at("k").get<int>() < best.at("k_max").get<int>());
    CHECK(max.at("k") == best.at("k_max"));
    CHECK(max.at("hits") == best.at("hits"));
    CHECK(result_of(line + " --spheres best").at("k") == best.at("k"));
    CHECK(result_of(line + " --spheres 2").at("k") == 2);
  }

  TEST_CASE("the phases add up to the time, and --repeat reports every run's") {
    for (const std::string repeat : {"", " --repeat 3", " --repeat 4"}) {
      const Json json = result_of("run @cornell --rays 2000 --technique sphere-cache" + repeat);
      const Json& seconds = json.at("seconds");
      double phases = 0;
      for (const std::string phase : {"prepare", "order", "build", "search"}) {
        CHECK(seconds.at(phase).get<double>() >= 0);
        phases += seconds.at(phase).get<double>();
      }
      CHECK(seconds.at("total").get<double>() >= phases * (1 - 1e-9));
      CHECK(seconds.at("search").get<double>() > 0);
      CHECK(json.at("read_seconds").get<double>() > 0);
      CHECK(json.at("trace_seconds").get<double>() > 0);
      CHECK(seconds.contains("all") == !repeat.empty());
      if (repeat.empty()) continue;
      CHECK(seconds.at("all").size() == (repeat.back() == '3' ? 3 : 4));
      const auto& all = seconds.at("all");
      CHECK(std::find(all.begin(), all.end(), seconds.at("total")) != all.end());
    }
  }

  TEST_CASE("reading the scene and making its rays have two numbers; reading rays from a file is reading" *
            doctest::test_suite("long")) {
    const support::ScratchFolder folder;
    const std::string rays = folder.path("rays.csv");
    CHECK(in_attempts(5, [&] {
      const Json scene = result_of(words("scene @cornell --samples 50 --rays 200k --write-rays") + Arguments{rays});
      return scene.at("trace_seconds").get<double>() > scene.at("read_seconds").get<double>();
    }));
    const std::string pipe = folder.path("pipe");
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    const std::jthread writer([&] {
      std::ofstream out(pipe);  // waits for the reader
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      out << content_of(rays);
    });
    const Json file = result_of(words("run @cornell --samples 50 --technique grid --ray-file") + Arguments{pipe});
    CHECK(file.at("trace_seconds") == 0);
    CHECK(file.at("read_seconds").get<double>() >= 0.1);
  }

  TEST_CASE("the text names the rays by their field, whatever the effects are") {
    const support::ScratchFolder folder;
    const std::string rays = folder.path("rays.csv");
    const auto line_of_rays = [](const Arguments& arguments) {
      const std::string text = detp(arguments + words("--quiet")).out;
      const std::size_t from = text.find("\nrays ");
      return text.substr(from, text.find('\n', from + 1) - from);
    };
    for (const std::string effects : {"auto", "none"}) {
      CAPTURE(effects);
      const Arguments line = words("scene @cornell --samples 50 --rays 1000 --effects " + effects);
      CHECK(line_of_rays(line + Arguments{"--write-rays", rays}).find(" pieces of photon paths, ") !=
            std::string::npos);
      CHECK(line_of_rays(line + words("--field isotropic")).ends_with(" isotropic lines"));
      const std::string file =
          line_of_rays(words("scene @cornell --samples 50 --effects " + effects + " --ray-file") + Arguments{rays});
      CHECK(file.find(" segments from a file, ") != std::string::npos);
      CHECK(file.find("light") == std::string::npos);
    }
  }

  TEST_CASE("more rays than a block are never all in memory; --pairs has their numbers among all rays" *
            doctest::test_suite("long")) {
    const Written written = run_and_read(words("run --samples 3 --disc-radius 0.3 --scene-side 2 --rays 1200000"),
                                         "--technique grid --cells 2");
    CHECK(written.json.at("rays_in_memory") == 1 << 18);
    CHECK(written.json.at("inputs").at("rays") == 1.2e6);
    const std::vector<std::string> pairs = rows_of(written.pairs);
    CHECK(pairs.size() == written.hits);
    const int last = std::stoi(pairs.back());
    CHECK(last > 1'190'000);
    CHECK(last < 1'200'000);
    CHECK(result_of("run @uniform --samples 10 --rays 1000 --technique grid").at("rays_in_memory") == 1000);
  }

  TEST_CASE("the files that `scene` writes are read back to the same result") {
    const ScratchFolder folder;
    const Arguments scene = words("scene @cornell --rays 1000 --samples 1500");
    const std::string discs = folder.path("discs.csv");
    const std::string rays = folder.path("rays.csv");
    const std::string mesh = folder.path("mesh.ply");
    CHECK(detp(scene + Arguments{"--write-discs", discs, "--write-rays", rays, "--write-mesh", mesh}).code == 0);
    const Written direct = run_and_read(words("run @cornell --rays 1000 --samples 1500"), "--technique grid");
    CHECK(run_and_read({"run", "--discs", discs, "--ray-file", rays}, "--technique octree").pairs == direct.pairs);
    const Json copy = result_of({"scene", mesh, "--rays", "1"});
    CHECK(copy.at("triangles") == result_of("scene @cornell --rays 1").at("triangles"));
  }
}

TEST_SUITE("statistical") {
  TEST_CASE("random lines hit discs as often as integral geometry says") {
    const Json json = result_of("run @uniform --samples 20000 --rays 200000 --technique grid");
    const double d = json.at("inputs").at("disc_radius");
    const double r0 = json.at("inputs").at("sphere_radius");
    const double per_line = 20000 * d * d / (2 * r0 * r0);
    const double expected = 200000 * per_line;
    // Lines are independent, but the hits of one line are not. A disc has the mean projected area pi d^2/2. So the
    // expected hits of a line are at most on_longest_chord, those along the longest chord of the cube of side 2. The
    // variance of a line's hits is below its mean times (1 + on_longest_chord).
    const double on_longest_chord = 20000 / 8.0 * 2 * std::sqrt(3.0) * std::numbers::pi * d * d / 2;
    const double standard_error = std::sqrt(expected * (1 + on_longest_chord));
    const double hits = json.at("hits");
    CHECK(std::abs(hits - expected) < 5 * standard_error);
    CHECK_MESSAGE(std::abs(hits - 1.1 * expected) > 5 * standard_error, "a formula wrong by 10 % must be refuted");
    CHECK_MESSAGE(std::abs(hits - 0.9 * expected) > 5 * standard_error, "a formula wrong by 10 % must be refuted");
  }
}

}  // namespace detp::support
