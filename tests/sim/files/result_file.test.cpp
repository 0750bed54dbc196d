#include "detp/sim/files/result_file.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "detp/sim/files/ply.hpp"
#include "detp/sim/files/table.hpp"
#include "support/scratch_file.hpp"

using namespace detp::sim;
using detp::support::ScratchFolder;
using Kind = ResultColumn::Kind;

namespace {

const std::vector<ResultColumn> result_columns{{"disc", Kind::index},
                                               {"x"},
                                               {"y"},
                                               {"z"},
                                               {"nx"},
                                               {"ny"},
                                               {"nz"},
                                               {"material", Kind::index, {"wall", "a, \"b\" --"}},
                                               {"hits", Kind::count},
                                               {"irradiance"}};
const std::vector<std::vector<double>> result_rows{{0, 0, 0, 0, 0, 0, 1, 1, 5e9, 0.1},
                                                   {1, 1, 0, 0, 0, 0, 1, 0, 3, 1.0 / 3},
                                                   {2, 0, 1, 0, 0, 0, 1, -1, 0, std::nan("")}};

void write_results(const std::string& path, const ResultPlaces& places = {}) {
  ResultFile file(path, result_columns, result_rows.size(), places, "discs", {});
  for (const auto& row : result_rows) file.write(row);
  file.commit();
}

/// The rows of a table with these columns.
std::vector<std::vector<double>> read_results(const std::string& path, double empty) {
  std::vector<TableColumn> known;
  for (const ResultColumn& one : result_columns) known.push_back({one.name, {}, empty});
  std::vector<std::vector<double>> found;
  read_table(path, known, [&](const TableRow& row) {
    std::vector<double>& own = found.emplace_back();
    for (std::size_t i = 0; i < known.size(); ++i) own.push_back(row[i]);
  });
  return found;
}

}  // namespace

TEST_SUITE("files of results") {
  TEST_CASE("the numbers come back from PLY and NumPy, with whole numbers as such") {
    const ScratchFolder folder;
    for (const char* name : {"a.ply", "a.NPY"}) {
      const std::string path = folder.path(name);
      write_results(path);
      const auto found = read_results(path, 0);
      REQUIRE(found.size() == result_rows.size());
      for (std::size_t i = 0; i < result_rows.size(); ++i)
        for (std::size_t column = 0; column < result_columns.size(); ++column)
          CHECK((found[i][column] == result_rows[i][column] || std::isnan(result_rows[i][column])));
    }
    const std::string ply = detp::support::content_of(folder.path("a.ply"));
    CHECK(ply.find("comment material 0 wall\ncomment material 1 a, _b_ _-\n") != std::string::npos);
    CHECK(ply.find("property int material\nproperty double hits\n") != std::string::npos);
    CHECK(detp::support::content_of(folder.path("a.NPY")).find("('hits', '<i8'), ('irradiance', '<f8')") !=
          std::string::npos);
  }

  TEST_CASE("CSV has names, and nothing where a number is not known") {
    const ScratchFolder folder;
    for (const char* name : {"a.csv", "a"}) {
      write_results(folder.path(name));
      CHECK(detp::support::content_of(folder.path(name)) ==
            "disc,x,y,z,nx,ny,nz,material,hits,irradiance\n0,0,0,0,0,0,1,\"a, \"\"b\"\" --\",5000000000,0.1\n"
            "1,1,0,0,0,0,1,wall,3,0.3333333333333333\n2,0,1,0,0,0,1,,0,\n");
    }
    CHECK(detp::support::file_error_of([&] {
            write_results(folder.path("a.obj"));
          }).find("must end in .csv, .ply, .vtp or .npy") != std::string::npos);
  }

  TEST_CASE("points with triangles, and triangles themselves, are meshes") {
    const ScratchFolder folder;
    const std::vector<std::array<std::uint32_t, 3>> one{{0, 1, 2}};
    const std::vector<std::array<std::uint32_t, 3>> three{{0, 1, 2}, {0, 2, 3}, {1, 2, 3}};
    const std::vector<glm::dvec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.1}};
    write_results(folder.path("points.ply"), {.triangles = one});
    write_results(folder.path("faces.ply"), {corners, three});
    const auto corners_of = [&](const char* name) {
      std::vector<double> found;
      PlyFile file(folder.path(name));
      const PlyElement* faces = file.element("face");
      REQUIRE(faces != nullptr);
      file.read({{.element = "face",
                  .properties = {faces->property("vertex_indices", true).value()},
                  .on_row = [&](std::uint64_t, const PlyValues& values) {
                    found.insert(found.end(), values[0].begin(), values[0].end());
                  }}});
      return found;
    };
    CHECK(corners_of("points.ply") == std::vector<double>{0, 1, 2});
    CHECK(corners_of("faces.ply") == std::vector<double>{0, 1, 2, 0, 2, 3, 1, 2, 3});
  }

  TEST_CASE("a VTK file says where its arrays are") {
    const ScratchFolder folder;
    const std::vector<std::array<std::uint32_t, 3>> one{{0, 1, 2}};
    for (const bool mesh : {false, true}) {
      CAPTURE(mesh);
      write_results(folder.path("a.vtp"), mesh ? ResultPlaces{.triangles = one} : ResultPlaces{});
      const std::string text = detp::support::content_of(folder.path("a.vtp"));
      CHECK(text.find(fmt::format("NumberOfPoints=\"3\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
                                  "NumberOfPolys=\"{}\"",
                                  mesh ? 0 : 3, mesh ? 1 : 0)) != std::string::npos);
      const std::string data = text.substr(text.find("\n_") + 2);
      const auto array = [&](const std::string& name, std::size_t element) {
        const std::string declared = text.substr(text.find("Name=\"" + name + "\""));
        const std::size_t offset = std::stoul(declared.substr(declared.find("offset=\"") + 8));
        std::array<char, 8> bytes{};
        data.copy(bytes.data(), 8, offset + 8 + 8 * element);
        return std::bit_cast<std::int64_t>(bytes);
      };
      CHECK(array("hits", 0) == 5'000'000'000);
      CHECK(std::bit_cast<double>(array("irradiance", 1)) == 1.0 / 3);
      CHECK(std::bit_cast<double>(array("positions", 3)) == 1);
      CHECK(array("material", 2) == -1);
    }
  }
}
