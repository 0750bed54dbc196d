#include "detp/sim/files/mesh_file.hpp"

#include <doctest/doctest.h>

#include "detp/sim/files/file_error.hpp"
#include "detp/sim/scene/vertices.hpp"
#include "support/scratch_file.hpp"

using namespace detp;
using namespace detp::sim;
using support::ScratchFolder;

namespace {

constexpr const char* square_obj = R"(# a square
mtllib missing.mtl
o square
v 0 0 0
v 1 0 0
v 1 1 0
  v 0 1 0
vt 0 0
vn 0 0 2
vn 0 3 0
usemtl white
s off
f 1/1/1 2//1 3//1 -1/1/2
)";

constexpr const char* square_ply = R"(ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 1
property list uchar int vertex_index
end_header
0 0 0
1 0 0
1 1 0
0 1 0
4 0 1 2 3
)";

Mesh read(const std::string& path) {
  Notices notices;
  return read_mesh(path, notices);
}

/// For each triangle the names of its groups.
std::vector<std::string> groups_in(const Mesh& mesh) {
  std::vector<std::string> all;
  for (const std::uint32_t set : mesh.groups.of_triangle) {
    std::string names;
    for (const std::uint32_t group : mesh.groups.sets.at(set)) names += mesh.groups.names.at(group) + "|";
    all.push_back(names);
  }
  return all;
}

std::string mesh_error(const std::string& name, const std::string& content) {
  const ScratchFolder folder;
  return support::file_error_of([&] { (void)read(folder.file(name, content)); });
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("an OBJ square becomes a fan of two triangles from its first corner, with the normals of its corners") {
    const ScratchFolder folder;
    const Mesh mesh = read(folder.file("square.OBJ", square_obj));
    REQUIRE(mesh.positions.size() == 4);
    CHECK(mesh.positions[3] == glm::dvec3{0, 1, 0});
    REQUIRE(mesh.triangles.size() == 2);
    CHECK(mesh.triangles[0] == std::array<std::uint32_t, 3>{0, 1, 2});
    CHECK(mesh.triangles[1] == std::array<std::uint32_t, 3>{0, 2, 3});
    REQUIRE(mesh.normals.size() == 4);
    CHECK(mesh.normals[0] == glm::dvec3{0, 0, 1});
    CHECK(mesh.normals[3] == glm::dvec3{0, 1, 0});
  }

  TEST_CASE("a PLY square gives the same triangles, and no normals") {
    const ScratchFolder folder;
    const Mesh mesh = read(folder.file("square.Ply", square_ply));
    CHECK(mesh.positions.size() == 4);
    CHECK(mesh.normals.empty());
    REQUIRE(mesh.triangles.size() == 2);
    CHECK(mesh.triangles[1] == std::array<std::uint32_t, 3>{0, 2, 3});
  }

  TEST_CASE("OBJ positions are the doubles nearest to the decimal numbers") {
    const ScratchFolder folder;
    const Mesh mesh = read(folder.file("m.obj", "v 5400000.8416139996 0.1 -1e-300\r\nv 1 0 0\r\nv +0 1 0\r\nf 1 2 3"));
    CHECK(mesh.positions[0] == glm::dvec3{5400000.8416139996, 0.1, -1e-300});
  }

  TEST_CASE("an OBJ with a byte order mark, and with any line ends, is read completely") {
    const ScratchFolder folder;
    for (const std::string end : {"\n", "\r\n", "\r"}) {
      CAPTURE(end);
      const std::string text = "v 1 0 0" + end + "v 2 0 0" + end + "v 3 1 0" + end + "f 1 2 3" + end;
      const Mesh mesh = read(folder.file("m.obj", "\xEF\xBB\xBF" + text));
      REQUIRE(mesh.positions.size() == 3);
      CHECK(mesh.positions[0] == glm::dvec3{1, 0, 0});
      CHECK(mesh.triangles.size() == 1);
    }
  }

  TEST_CASE("a backslash at the end of an OBJ line joins the next one, but not in a comment") {
    const ScratchFolder folder;
    const Mesh mesh = read(folder.file("m.obj",
                                       "# exported from C:\\models\\\nv 0 \\\n0 \\\r\n 0\nv 1 0 0\\\n 0.5 0.5\n"
                                       "v 0 1 0\nv 1 1 0\nf 1 2\\\n4 \\\n3\\"));
    REQUIRE(mesh.positions.size() == 4);
    CHECK(mesh.positions[1] == glm::dvec3{1, 0, 0});
    REQUIRE(mesh.triangles.size() == 2);
    CHECK(mesh.triangles[1] == std::array<std::uint32_t, 3>{0, 3, 2});
  }

  TEST_CASE("an OBJ face is in its object and in all groups of the last g line, wherever its vertices are") {
    const ScratchFolder folder;
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    const std::string faces =
        "f 1 2 3\ng unused\ng wall north  \nf 1 2 3 4\no My house \t\u00a0\r\nf 1 2 3\ng\nf 1 2 3\no\nf 1 2 3\n"
        "g roof # flat\nf 1 2 3\ng north wall \\\n wall\nf 1 2 3\n";
    for (const std::string& text : {corners + faces, faces + corners}) {
      const Mesh mesh = read(folder.file("m.obj", text));
      CHECK(groups_in(mesh) == std::vector<std::string>{"", "wall|north|", "wall|north|", "wall|north|My house|",
                                                        "My house|default|", "default|", "roof|", "wall|north|"});
      CHECK(mesh.groups.names == std::vector<std::string>{"unused", "wall", "north", "My house", "default", "roof"});
      CHECK(mesh.groups.sets.size() == 6);
    }
    CHECK(read(folder.file("m.obj", corners + "f 1 2 3\ng late\n")).groups.of_triangle.empty());
  }

  TEST_CASE("OBJ lines with unknown keywords are skipped with a notice") {
    const ScratchFolder folder;
    Notices notices;
    const Mesh mesh = read_mesh(
        folder.file("m.obj", "v 0 0 0\nv 1 0 0\n\x1b[2Jv 5 5 5\nv 0 1 0\nmaterial \n#\ng a b\nf 1 2 3\n"), notices);
    CHECK(mesh.positions.size() == 3);
    REQUIRE(notices.size() == 1);
    CHECK(notices[0] == "lines with keywords unknown to OBJ, skipped: 2, the first \"\\x1b[2Jv\" in line 3");
  }

  TEST_CASE("an OBJ polygon may have more than 255 corners") {
    std::string text;
    std::string face = "f";
    for (int i = 1; i <= 300; ++i) {
      text += "v " + std::to_string(i) + " 0 " + std::to_string(i * i) + "\n";
      face += " " + std::to_string(i);
    }
    const ScratchFolder folder;
    CHECK(read(folder.file("m.obj", text + face)).triangles.size() == 298);
  }

  TEST_CASE("an OBJ position with several normals becomes a vertex for each of them") {
    const ScratchFolder folder;
    const std::string positions = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 5\nvn 0 0 -1\nvn 7 0 0\n";
    for (const std::string& text : {positions + "f 1//1 2//1 3//1\nf 1//3 3//1 2//1\nf 3//1 1//3 2//2\n",
                                    "f 1//1 2//1 3//1\nf 1//3 3//1 2//1\nf 3//1 1//3 2//2\n" + positions}) {
      CAPTURE(text);
      const Mesh mesh = read(folder.file("split.obj", text));
      REQUIRE(mesh.positions.size() == 5);
      CHECK(mesh.triangles[1] == std::array<std::uint32_t, 3>{3, 2, 1});
      CHECK(mesh.triangles[2] == std::array<std::uint32_t, 3>{2, 3, 4});
      CHECK(mesh.file_vertices == std::vector<std::uint32_t>{0, 1, 2, 0, 1});
      CHECK(mesh.normals[0] == glm::dvec3{0, 0, 1});
      CHECK(mesh.normals[3] == glm::dvec3{1, 0, 0});
      CHECK(mesh.normals[4] == glm::dvec3{0, 0, -1});
      CHECK(mesh.positions[4] == glm::dvec3{1, 0, 0});
    }
  }

  TEST_CASE("normals that are missing, zero or not finite become those of the faces, with a notice") {
    const ScratchFolder folder;
    const std::string positions = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 1\n";
    for (const char* bad :
         {"vn 0 0 0\nf 1//1 2//1 3//2\n", "vn nan 0 0\nf 1//1 2//1 3//2\n", "vn inf 0 0\nf 1//1 2//1 3//2\n",
          "f 1//1 2//1 3\n", "f 1//1 2//1 3//7\n", "f 1//1 2//1 3//-4\n", "vn -nan(ind) 0 1\nf 1//1 2//1 3//2\n"}) {
      CAPTURE(bad);
      Notices notices;
      Mesh mesh = read_mesh(folder.file("m.obj", positions + bad), notices);
      CHECK(mesh.normals_made == 1);
      REQUIRE(notices.size() == 1);
      CHECK(notices[0].find("with that of the faces around: 1") != std::string::npos);
      const std::vector<Sample> samples = samples_at_vertices(mesh, default_crease, notices);
      REQUIRE(samples.size() == 3);
      CHECK(samples[0].normal.x == doctest::Approx(std::sqrt(0.5)));
      CHECK(samples[2].normal == glm::dvec3{0, 0, 1});
    }
    Notices notices;
    const Mesh none = read_mesh(folder.file("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//1 2//1 3//1\n"), notices);
    CHECK(none.normals.empty());
    CHECK(none.normals_made == 3);
    CHECK(notices.size() == 1);
    std::string ply = square_ply;
    ply.replace(ply.find("element face"), 0, "property float nx\nproperty float ny\nproperty float nz\n");
    for (const char* corner : {"0 0 0\n", "1 0 0\n", "0 1 0\n"})
      ply.replace(ply.find(corner), 6, std::string(corner, 5) + " 0 0 1\n");
    ply.replace(ply.find("1 1 0\n"), 6, "1 1 0 nan 0 0\n");
    Mesh bad = read_mesh(folder.file("m.ply", ply), notices);
    CHECK(bad.normals_made == 2);  // corners of two triangles, or of one
    CHECK(samples_at_vertices(bad, default_crease, notices).size() == 4);
  }

  TEST_CASE("polygons are divided alike in OBJ and PLY, also where faces come before vertices") {
    const ScratchFolder folder;
    const std::string bent = "2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n0 0 0\n";
    std::string vertices;
    for (std::size_t i = 0; i < bent.size(); i += 6) vertices += "v " + bent.substr(i, 6);
    const std::string head = "ply\nformat ascii 1.0\n";
    const std::string of_vertices = "element vertex 6\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string of_faces = "element face 1\nproperty list uchar int vertex_indices\n";
    const std::vector<std::array<std::uint32_t, 3>> expected =
        read(folder.file("m.obj", vertices + "f 1 2 3 4 5 6\n")).triangles;
    double area = 0;
    for (const auto& [a, b, c] : expected) {
      const Mesh mesh = read(folder.path("m.obj"));
      area += 0.5 * glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]).z;
    }
    CHECK(area == doctest::Approx(3));
    for (const auto& [bound_name, text] :
         {std::pair<std::string, std::string>{"before.obj", "f 1 2 3 4 5 6\n" + vertices},
          {"old.obj", vertices + "fo 1 2 3 4 5 6\n"},
          {"closed.obj", vertices + "f 1 2 3 4 5 6 1\n"},
          {"comment.obj", vertices + "f 1 2 3 4 5 6 # bent\n"},
          {"m.ply", head + of_vertices + of_faces + "end_header\n" + bent + "6 0 1 2 3 4 5\n"},
          {"before.ply", head + of_faces + of_vertices + "end_header\n6 0 1 2 3 4 5\n" + bent},
          {"closed.ply", head + of_vertices + of_faces + "end_header\n" + bent + "8 0 1 2 2 3 4 5 0\n"}}) {
      const std::string& name = bound_name;
      CAPTURE(name);
      CHECK(read(folder.file(name, text)).triangles == expected);
    }
  }

  TEST_CASE("PLY triangle strips alternate their orientation, end with -1 and may turn by repeated corners") {
    const ScratchFolder folder;
    const std::string text =
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
        "element tristrips 1\nproperty list int int vertex_indices\nelement face 0\n"
        "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n";
    const std::vector<std::array<std::uint32_t, 3>> expected{{0, 1, 3}, {3, 1, 2}, {0, 1, 4}};
    CHECK(read(folder.file("m.ply", text + "8 0 1 3 2 -1 0 1 4\n")).triangles == expected);
    CHECK(read(folder.file("m.ply", text + "6 0 1 3 3 2 4\n")).triangles.size() == 2);
    CHECK_THROWS_WITH_AS((void)read(folder.file("m.ply", text + "3 0 1 9\n")), doctest::Contains("strip 1: index"),
                         FileError);
    CHECK_THROWS_WITH_AS((void)read(folder.file("m.ply", text + "3 0 1 -2\n")), doctest::Contains("strip 1: index"),
                         FileError);
  }

  TEST_CASE("an unused position that is not finite is set to 0, with a notice") {
    const ScratchFolder folder;
    Notices notices;
    const Mesh mesh =
        read_mesh(folder.file("m.obj", "v nan -inf 1.#IND\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\n"), notices);
    CHECK(mesh.positions[0] == glm::dvec3{0, 0, 0});
    REQUIRE(notices.size() == 1);
    CHECK(notices[0] == "unused positions that are not finite, set to 0: 1");
  }

  TEST_CASE("every test scene has the triangles and vertices that its table states" * doctest::test_suite("scenes")) {
    const std::string folder = support::scenes_folder();
    if (folder.empty()) return;
    struct Expected {
      const char* name;
      std::size_t triangles, vertices;
    };
    for (const auto& [bound_name, triangles, vertices] : {Expected{"cornell_box.obj", 36, 76},
                                                          {"stanford_bunny.obj", 59664, 29834},
                                                          {"stanford_dragon.ply", 43534, 21790},
                                                          {"sponza.ply", 187364, 131941},
                                                          {"bedroom.ply", 449392, 252187},
                                                          {"mountain.obj", 50562, 25600},
                                                          {"tangerine_fine.ply", 72470, 40838},
                                                          {"tangerine_coarse.ply", 18384, 17691},
                                                          {"grove_fine.ply", 72456, 67422},
                                                          {"grove_coarse.ply", 18770, 25415},
                                                          {"tree.obj", 6392, 3880},
                                                          {"tree_lods/tree1b_lod0_1.obj", 1168, 1949},
                                                          {"tree_lods/tree1b_lod0_2.obj", 899, 1949},
                                                          {"tree_lods/tree1b_lod1_1.obj", 689, 1293},
                                                          {"tree_lods/tree1b_lod1_2.obj", 605, 1293},
                                                          {"tree_lods/tree1b_lod2_1.obj", 292, 739},
                                                          {"tree_lods/tree1b_lod2_2.obj", 245, 739},
                                                          {"pathological/coplanar_stack.obj", 200, 4},
                                                          {"pathological/degenerate_mix.obj", 1523, 708},
                                                          {"pathological/flat_axis_aligned.obj", 128, 81},
                                                          {"pathological/huge_offset.obj", 1654, 829},
                                                          {"pathological/huge_scale.obj", 1654, 829},
                                                          {"pathological/mixed_scale.obj", 1656, 833},
                                                          {"pathological/nonmanifold.obj", 74, 61},
                                                          {"pathological/single_triangle.obj", 1, 3},
                                                          {"pathological/slivers.obj", 1800, 3002},
                                                          {"pathological/tiny_scale.obj", 1654, 829}}) {
      const auto& name = bound_name;
      CAPTURE(name);
      const Mesh mesh = read(folder + "/" + name);
      CHECK(mesh.triangles.size() == triangles);
      CHECK((mesh.file_vertices.empty() ? mesh.positions.size()
                                        : std::size_t{1} + *std::ranges::max_element(mesh.file_vertices)) == vertices);
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("test scenes without faces, or with faces at positions that are not finite, are refused" *
            doctest::test_suite("scenes")) {
    const std::string folder = support::scenes_folder();
    if (folder.empty()) return;
    CHECK_THROWS_WITH_AS((void)read(folder + "/pathological/no_faces.obj"), doctest::Contains("has no faces"),
                         FileError);
    CHECK_THROWS_WITH_AS((void)read(folder + "/pathological/nonfinite_vertices.obj"), doctest::Contains("not finite"),
                         FileError);
  }

  TEST_CASE("a refused OBJ file is reported with its line and the reason") {
    const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    support::check_errors(
        {{triangle + "f 1 2 4\n", ":4: vertex 4 is"},
         {triangle + "f 1 2 0\n", ":4: vertex 0 is"},
         {triangle + "f -4 2 1\n", ":4: vertex -4 is"},
         {triangle + "f 1 2\n", ":4: a face needs"},
         {triangle + "f 1 2 2 1\n", ":4: a face needs"},
         {"f 1 2 3\nf 1 2 9\nf 1 2 4\n" + triangle, ":2: vertex 9 is out of range, there are 3"},
         {triangle + "f 1 2 3x\n", ":4: \"3x\" is not a corner"},
         {triangle + "f 1 2 3.5\n", ":4: \"3.5\" is not a corner"},
         {triangle + "f 1 2 3/1/1/1\n", ":4: \"3/1/1/1\" is not a corner"},
         {triangle + "f 1 2 /3\n", ":4: vertex 0 is"},
         {triangle + "f 1 2 \\ 3\n", ":4: \"\\\" is not a corner"},
         {triangle + "\\\nf 1 2 \\\n9\n", ":4: vertex 9 is"},
         {triangle + "f 1 2 4294967299\n", ":4: vertex 4294967299 is"},
         {triangle + "f 1 2 -9223372036854775808\n", ":4: vertex -9223372036854775808 is"},
         {triangle + "f 1 2 99999999999999999999\n", ":4: an index of \"99999999999999999999\" is out of range"},
         {"v 0 \x1b[31m 0\n" + triangle, ":1: \"\\x1b[31m\" is not a number"},
         {"v 0 \xc2\x9b 0\n" + triangle, ":1: \"\\xc2\\x9b\" is not a number"},
         {"v 0 " + std::string(3'000'000, '1') + "x 0\n", ":1: \"" + std::string(60, '1') + "...\" is not a number"},
         {std::string("v 0 0 0\nv 1 0 0\0\nv 0 1 0\nf 1 2 3\n", 34), ":2: contains a NUL byte"},
         {std::string("\xFF\xFEv\0 \0", 6), ": is text in UTF-16"},
         {"\xEF\xBB\xBF\xEF\xBB\xBFv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ":4: vertex 3 is"},
         {std::string(300, '\n') + "x\n", ": has no faces"},
         {"v 0 zero 0\n" + triangle + "f 1 2 3\n", ":1: \"zero\" is not"},
         {"v 0 0\n" + triangle + "f 1 2 3\n", ":1: has too few"},
         {"v 0 nan 0\n" + triangle + "f 1 2 3\n", ": vertex 1 (counting from 1)"},
         {[] {
            std::string text;
            for (int i = 0; i < 101; ++i) text += "y\n";
            return text;
          }(),
          ":101: most lines so far have keywords unknown"},
         {[&] {
            std::string names;
            for (int i = 0; i < 101; ++i) names += " " + std::to_string(i);
            return triangle + "g" + names + "\n";
          }(),
          ":4: a face can be in 100 groups"},
         {triangle, ": has no faces"},
         {"", ": has no faces"}},
        [&](const std::string& content) { return mesh_error("m.obj", content); }, "m.obj");
  }

  TEST_CASE("a refused PLY mesh is reported with the reason") {
    const auto changed = [](const std::string& from, const std::string& to) {
      std::string text = square_ply;
      return text.replace(text.find(from), from.size(), to);
    };
    support::check_errors({{changed("4 0 1 2 3", "4 0 1 2 4"), "face 1: index out of range"},
                           {changed("4 0 1 2 3", "4 0 1 2 -1"), "face 1: index out of range"},
                           {changed("4 0 1 2 3", "2 0 1"), "face 1: needs at least 3 corners"},
                           {changed("1 1 0", "1 inf 0"), "vertex 3 (counting from 1)"},
                           {changed("vertex_index", "corners"), "no list vertex_indices"},
                           {changed("property float z", "property float w"), "no element vertex with"},
                           {changed("face 1", "edge 1"), "has no faces"},
                           {"", "is empty"}},
                          [&](const std::string& content) { return mesh_error("m.ply", content); });
  }

  TEST_CASE("folders, missing files and other file types are refused with their name") {
    const ScratchFolder folder;
    std::filesystem::create_directory(folder.path("d.obj"));
    for (const char* name : {"d.obj", "missing.ply", "mesh.stl"})
      CHECK_THROWS_WITH_AS((void)read(folder.path(name)), doctest::Contains(name), FileError);
  }

  TEST_CASE("a damaged mesh file is read or refused, with no other effect") {
    const auto read_any = [](const std::string& path) { (void)read(path); };
    CHECK(support::refused_when_damaged("m.obj", square_obj, 1500, read_any) > 100);
    CHECK(support::refused_when_damaged("m.ply", square_ply, 1500, read_any) > 100);
  }
}
