#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

#include "support/command.hpp"
#include "support/csv_answer.hpp"

namespace detp::support {
namespace {

using Point = std::array<double, 3>;

/// An OBJ file of quads.
class Quads {
 public:
  /// A parallelogram, n × n quads; its front is that of `first` × `second`.
  void grid(const Point& at, const Point& first, const Point& second, int n, bool turned = false) {
    const int start = vertices_;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j) {
        const auto along = [&](std::size_t axis) { return at[axis] + (first[axis] * i + second[axis] * j) / n; };
        text_ += fmt::format("v {} {} {}\n", along(0), along(1), along(2));
        ++vertices_;
      }
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const int a = start + i * (n + 1) + j + 1;
        const int b = a + n + 1;
        text_ += turned ? fmt::format("f {} {} {} {}\n", a + 1, b + 1, b, a)
                        : fmt::format("f {} {} {} {}\n", a, b, b + 1, a + 1);
      }
  }
  void material(const char* name) { text_ += fmt::format("usemtl {}\n", name); }
  [[nodiscard]] std::string text() const { return "mtllib all.mtl\nusemtl wall\n" + text_; }

 private:
  std::string text_;
  int vertices_ = 0;
};

constexpr const char* materials = "newmtl wall\nKd 0.5\nnewmtl lamp\nKd 0\nKe 1\nnewmtl glowing\nKd 0.5\nKe 1\n";

/// A cube that emits inwards: corners shared, repeated for each face, or shared with the faces' normals.
std::string cube(int indexing) {
  const std::array<std::array<int, 4>, 6> faces{
      {{2, 3, 4, 1}, {8, 7, 6, 5}, {5, 6, 2, 1}, {6, 7, 3, 2}, {7, 8, 4, 3}, {8, 5, 1, 4}}};
  const std::array<const char*, 9> corners{"", "0 0 0", "1 0 0", "1 1 0", "0 1 0", "0 0 1", "1 0 1", "1 1 1", "0 1 1"};
  std::string text = "mtllib all.mtl\nusemtl glowing\n";
  if (indexing != 1)
    for (std::size_t i = 1; i < corners.size(); ++i) text += fmt::format("v {}\n", corners[i]);
  if (indexing == 2) text += "vn 0 0 1\nvn 0 0 -1\nvn 0 1 0\nvn -1 0 0\nvn 0 -1 0\nvn 1 0 0\n";
  for (std::size_t face = 0; face < faces.size(); ++face) {
    std::string corners_of_face = "f";
    for (const int corner : faces[face]) {
      if (indexing == 1) text += fmt::format("v {}\n", corners[static_cast<std::size_t>(corner)]);
      corners_of_face += indexing == 0 ? fmt::format(" {}", corner)
                         : indexing == 1
                             ? fmt::format(" {}", -4 + std::ranges::find(faces[face], corner) - faces[face].begin())
                             : fmt::format(" {}//{}", corner, face + 1);
    }
    text += corners_of_face + "\n";
  }
  return text;
}

struct PerDisc {
  Json json;
  std::vector<double> irradiance = {};
  std::vector<std::string> vertices = {};
};

PerDisc run_per_disc(const ScratchFolder& folder, const std::string& arguments) {
  const std::string path = folder.path("per_disc.csv");
  PerDisc found{.json = result_of("run " + arguments + " --per-disc " + path)};
  for (const CsvRow& row : csv_rows(content_of(path))) {
    found.irradiance.push_back(number(row, "irradiance"));
    found.vertices.push_back(row.at("vertex"));
  }
  return found;
}

std::vector<double> in_order(std::vector<double> values) {
  std::ranges::sort(values);
  return values;
}

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("a closed cube has the same irradiance whatever its indexing: 2 pi by landings" *
            doctest::test_suite("long")) {
    const ScratchFolder folder;
    (void)folder.file("all.mtl", materials);
    std::vector<std::string> files;
    for (int indexing = 0; indexing < 3; ++indexing)
      files.push_back(folder.file(fmt::format("cube{}.obj", indexing), cube(indexing)));
    for (const std::string estimator : {"disc", "variable-radius", "area-corrected", "triangle-hits"}) {
      CAPTURE(estimator);
      const std::string options = " --rays 40000 --disc-radius 0.2 --estimator " + estimator;
      const PerDisc shared = run_per_disc(folder, files[0] + options);
      REQUIRE(shared.irradiance.size() == 24);
      for (std::size_t i = 1; i < 3; ++i) {
        const PerDisc other = run_per_disc(folder, files[i] + options);
        REQUIRE(other.irradiance.size() == 24);
        const std::vector<double> one = in_order(shared.irradiance);
        const std::vector<double> two = in_order(other.irradiance);
        CHECK(one == two);
      }
      const double mean = shared.json.at("mean_irradiance").get<double>() / (2 * std::numbers::pi);
      if (estimator == "area-corrected" || estimator == "triangle-hits") CHECK(std::abs(mean - 1) < 0.02);
      CHECK(mean > 0.3);
    }
  }

  TEST_CASE("results name the vertices of the file, and --crease joins what an edge divides" *
            doctest::test_suite("long")) {
    const ScratchFolder folder;
    (void)folder.file("all.mtl", materials);
    const std::string file = folder.file("cube.obj", cube(0));
    const PerDisc sharp = run_per_disc(folder, file + " --rays 2000");
    CHECK(sharp.vertices.size() == 24);
    CHECK(sharp.vertices[3] == "1");
    CHECK_FALSE(sharp.json.at("inputs").contains("crease"));
    const PerDisc smooth = run_per_disc(folder, file + " --rays 2000 --crease 100");
    CHECK(smooth.vertices.size() == 8);
    CHECK(smooth.json.at("inputs").at("crease") == 100);
    CHECK(run_per_disc(folder, file + " --rays 2000 --samples 30").vertices.back() == "-1");
    const std::string discs = folder.path("discs.csv");
    CHECK(detp("scene " + file + " --rays 10 --write-discs " + discs).code == 0);
    CHECK(content_of(discs).starts_with("x,y,z,nx,ny,nz,radius,vertex\n"));
    CHECK(run_per_disc(folder, file + " --rays 2000 --discs " + discs).vertices.back() == "-1");
    for (const char* crease : {"-1", "181", "nan", "sharp"}) {
      CAPTURE(crease);
      CHECK(detp("scene " + file + " --crease " + crease).code == 2);
    }
    CHECK(detp("run --scene-side 2 --samples 10 --disc-radius 0.1 --crease 20").code == 2);
    const std::string accuracy = "accuracy " + file + " --effort quick --estimators triangle-hits";
    CHECK(result_of(accuracy).at("inputs").at("samples") == 24);
    const Json joined = result_of(accuracy + " --crease 100");
    CHECK(joined.at("inputs").at("samples") == 8);
    CHECK(joined.at("inputs").at("crease") == 100);
    CHECK(joined.at("answer").at("command").get<std::string>().find("--crease 100") != std::string::npos);
  }

  TEST_CASE("floors and lamps that are listed twice give the light of single ones, also where they scatter" *
            doctest::test_suite("long")) {
    const ScratchFolder folder;
    (void)folder.file("all.mtl", materials);
    const std::string discs = folder.file("discs.csv", "x,y,z,nx,ny,nz,radius\n0.5,0,0.5,0,1,0,0.2\n");
    const auto scene = [&](bool floor_turned, bool floor_again, bool finer, bool lamp_again) {
      Quads quads;
      const auto floor = [&](int n, bool turned) { quads.grid({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, n, turned); };
      floor(6, false);
      if (floor_turned) floor(6, true);
      if (floor_again) floor(6, false);
      if (finer) floor(5, false);
      quads.grid({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 2);
      quads.material("lamp");
      for (int i = 0; i < (lamp_again ? 2 : 1); ++i) quads.grid({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 2);
      return folder.file("floor.obj", quads.text());
    };
    for (const std::string estimator : {"disc", "area-corrected", "triangle-hits"}) {
      CAPTURE(estimator);
      const auto irradiance = [&](const std::string& file, int coincident) {
        const PerDisc found =
            run_per_disc(folder, file + " --rays 100000 --discs " + discs + " --estimator " + estimator);
        CHECK(found.json.at("geometry").at("coincident") == coincident);
        return found.irradiance.at(0);
      };
      const double single = irradiance(scene(false, false, false, false), 0);
      CHECK(irradiance(scene(true, false, false, false), 72) == doctest::Approx(single).epsilon(0.03));
      CHECK(irradiance(scene(false, true, false, false), 72) == doctest::Approx(single).epsilon(0.03));
      CHECK(irradiance(scene(false, false, true, false), 50) == doctest::Approx(single).epsilon(0.03));
      CHECK(irradiance(scene(true, true, true, true), 72 + 72 + 50 + 8) == doctest::Approx(single).epsilon(0.03));
    }
  }

  TEST_CASE("the room behind a partition, and the far side of a thin board, stay dark") {
    const ScratchFolder folder;
    (void)folder.file("all.mtl", materials);
    for (const bool board : {false, true}) {
      CAPTURE(board);
      Quads quads;
      for (const double x : {0.0, 1.0}) {
        quads.grid({x, 0, 0}, {1, 0, 0}, {0, 1, 0}, 6);
        quads.grid({x, 0, 1}, {0, 1, 0}, {1, 0, 0}, 6);
        quads.grid({x, 0, 0}, {0, 0, 1}, {1, 0, 0}, 6);
        quads.grid({x, 1, 0}, {1, 0, 0}, {0, 0, 1}, 6);
      }
      quads.grid({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 6);
      quads.grid({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 6);
      if (board) quads.grid({1.01, 0, 0}, {0, 1, 0}, {0, 0, 1}, 6);
      quads.grid({2, 0, 0}, {0, 0, 1}, {0, 1, 0}, 6);
      quads.material("lamp");
      quads.grid({0.3, 0.3, 0.99}, {0, 0.4, 0}, {0.4, 0, 0}, 1);
      const std::string file = folder.file("rooms.obj", quads.text());
      std::string dark = "x,y,z,nx,ny,nz,radius\n";
      for (int i = 0; i < 20; ++i) {
        dark += fmt::format("{},{},0,0,0,1,0.05\n", 1.07 + 0.04 * i, 0.1 + 0.04 * i);
        if (board) dark += fmt::format("1.01,{},{},1,0,0,0.05\n", 0.1 + 0.04 * i, 0.02 + 0.04 * i);
      }
      const std::string discs = folder.file("dark.csv", dark);
      const PerDisc found = run_per_disc(folder, file + " --rays 200000 --front-facing --discs " + discs);
      for (const auto& effect : found.json.at("effects"))
        if (effect.at("name") == "concave surfaces") CHECK(effect.at("on") == true);
      for (const double irradiance : found.irradiance) CHECK(irradiance == 0);
    }
  }
}

}  // namespace detp::support
