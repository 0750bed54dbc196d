#include "detp/sim/files/mesh_file.hpp"

#include <doctest/doctest.h>

#include "support/scratch_file.hpp"

using namespace detp;
using namespace detp::sim;

TEST_SUITE("identity") {
  TEST_CASE("a written mesh is read back bit for bit, with and without normals") {
    Mesh mesh{.positions = {{0.1, -1e-300, 1e300}, {1.0 / 3, 0, 0}, {0, 1, 0}, {7, 7, 7}},
              .normals = {},
              .triangles = {{0, 1, 2}, {3, 2, 0}, {1, 1, 1}}};
    const support::ScratchFolder folder;
    for (const bool with_normals : {false, true}) {
      if (with_normals) mesh.normals = {{0, 0, 1}, {0, 0.1, 0}, {1e-200, 0, 0}, {1, 2, 3}};
      write_ply(folder.path("mesh.ply"), mesh);
      Notices notices;
      const Mesh back = read_mesh(folder.path("mesh.ply"), notices);
      CHECK(back.positions == mesh.positions);
      CHECK(back.normals == mesh.normals);
      CHECK(back.triangles == mesh.triangles);
      REQUIRE(notices.size() == 1);
      CHECK(notices[0] == "faces without area, or that cross themselves: 1");
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a damaged binary mesh is read or refused, with no other effect") {
    const support::ScratchFolder folder;
    write_ply(folder.path("mesh.ply"),
              {.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .normals = {}, .triangles = {{0, 1, 2}}});
    const std::string content = support::content_of(folder.path("mesh.ply"));
    const std::size_t refused = support::refused_when_damaged("m.ply", content, 2500, [](const std::string& path) {
      Notices notices;
      (void)read_mesh(path, notices);
    });
    CHECK(refused > content.size());
  }
}
