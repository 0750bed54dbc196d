#include "detp/sim/files/mtl_file.hpp"

#include <doctest/doctest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/files/file_error.hpp"
#include "detp/sim/files/mesh_file.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "support/scratch_file.hpp"
#include "support/work_log.hpp"

using namespace detp::sim;
using detp::support::ScratchFolder;
namespace support = detp::support;

namespace {

std::vector<Material> materials_in(const std::string& text, Notices* notices = nullptr) {
  Notices ignored;
  const ScratchFolder folder;
  return read_mtl(folder.file("materials.mtl", text), notices != nullptr ? *notices : ignored);
}

Material material_in(const std::string& statements) {
  const auto all = materials_in("newmtl one\n" + statements);
  REQUIRE(all.size() == 1);
  return all[0];
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("colours are kept beside their luminance; the filter of glass, too") {
    CHECK_FALSE(material_in("Kd 0.4\nKs 0.1 0.1 0.1\nNs 20\n").colours);
    const Material red = material_in("Kd 0.8 0.2 0.1\nKs 0 0.1 0\nNs 20\nKe 0 0 5\n");
    REQUIRE(red.colours);
    CHECK(red.diffuse == doctest::Approx(0.2126 * 0.8 + 0.7152 * 0.2 + 0.0722 * 0.1));
    CHECK(glm::length(red.colours->diffuse - glm::dvec3(0.8, 0.2, 0.1)) < 1e-15);
    CHECK(glm::length(red.colours->specular - glm::dvec3(0, 0.1, 0)) < 1e-15);
    CHECK(red.colours->emitted == glm::dvec3(0, 0, 5));
    const Material glass = material_in("Kd 0.5 0.1 0.1\nTf 0.9 1 7\nd 0.25\n");
    REQUIRE(glass.colours);
    CHECK(glm::length(glass.colours->diffuse - 0.25 * glm::dvec3(0.5, 0.1, 0.1)) < 1e-15);
    CHECK(glass.colours->glass == 0.75 * glm::dvec3(0.9, 1, 1));
    const Material bright = material_in("Kd 1 0.9 0.2\nKs 0.5 0.1 0\nNs 20\n");
    REQUIRE(bright.colours);
    for (int band = 0; band < 3; ++band) CHECK(bright.colours->diffuse[band] + bright.colours->specular[band] <= 1);
  }

  TEST_CASE("colours become their luminance; one number is a grey") {
    const Material one = material_in("Kd 1 0.5 0\nKe 2\nKs 0 0 0\n");
    CHECK(one.name == "one");
    CHECK(one.diffuse == doctest::Approx(0.2126 + 0.5 * 0.7152));
    CHECK(one.emitted == doctest::Approx(2));
    CHECK(one.specular == 0);
    CHECK(one.glass == 0);
  }

  TEST_CASE("Ns makes gloss, from 1000 or with illum 3 or 5 a mirror; illum 0 and 1 have no gloss") {
    CHECK(material_in("Kd 0.1\nKs 0.5\nNs 50\nillum 2\n").shininess == 50);
    CHECK(material_in("Kd 0.1\nKs 0.5\nNs 50\nillum 2\n").specular == doctest::Approx(0.5));
    CHECK(std::isinf(material_in("Ks 0.5\nNs 1000\n").shininess));
    CHECK(std::isinf(material_in("Ks 0.5\nNs 10\nillum 3\n").shininess));
    CHECK(material_in("Ks 0.5\nNs 50\nillum 1\n").specular == 0);
    CHECK(material_in("Ks 0.5\nNs 0\n").specular == 0);
  }

  TEST_CASE("glass by opacity, with its index; not by illum alone") {
    const Material glass = material_in("Kd 0.2\nTr 1\nillum 7\nNi 1.33\n");
    CHECK(glass.glass == 1);
    CHECK(glass.diffuse == 0);
    CHECK(glass.index == 1.33);
    for (const char* illum : {"illum 4\n", "illum 6\nNi 1\n", "illum 7\n", "d 1\nillum 9\n"})
      CHECK(material_in(illum).glass == 0);
    const Material tinted = material_in("Kd 0.4\nd -halo 0.25\nNi 1\n");
    CHECK(tinted.glass == 0.75);
    CHECK(tinted.diffuse == doctest::Approx(0.1));
    CHECK(tinted.index == 1.5);
    CHECK(material_in("Tr 0.75\n").glass == 0.75);
  }

  TEST_CASE("d 0, and Tr 1 without d below illum 3, are opaque; d counts before Tr; each rule names its materials") {
    Notices notices;
    const auto all = materials_in(
        "newmtl zero\nd 0\nnewmtl zero glass\nd 0\nillum 7\nnewmtl one\nTr 1\nnewmtl one of two\nTr 1\nillum 2\nnewmtl "
        "both\nd 1\nTr 1\n"
        "newmtl other\nTr 0\nd 0.5\nnewmtl agree\nTr 0.3\nd 0.7\n",
        &notices);
    for (std::size_t i = 0; i < 5; ++i) {
      CAPTURE(all.at(i).name);
      CHECK(all[i].glass == 0);
      CHECK(all[i].diffuse == 0.5);
    }
    CHECK(all.at(5).glass == 0.5);
    CHECK(all.at(6).glass == doctest::Approx(0.3));
    REQUIRE(notices.size() == 2);
    CHECK(notices[0].find("taken as opaque (zero, zero glass, one, ...): 4") != std::string::npos);
    CHECK(notices[1].find("contradict each other, taken by d (both, other): 2") != std::string::npos);
  }

  TEST_CASE("Kd and Ks of 1 or more together are lowered below 0.98; a single share of 1 stays; both have a notice") {
    Notices notices;
    const auto all = materials_in(
        "newmtl blender\nNs 250\nKd 0.8\nKs 0.5\nillum 2\nmap_Kd wood.png\nnewmtl white\nKd 1 1 1\nnewmtl mirror\nKd "
        "0\nKs 1\n"
        "Ns 1000\nnewmtl bright\nKd 1.2\nnewmtl half\nKd 0.6\nKs 0.4\nNs 9\nnewmtl less\nKd 0.999\n",
        &notices);
    CHECK(all.at(0).diffuse == 0.8);
    CHECK(all.at(0).specular == doctest::Approx(0.09));
    CHECK(all.at(1).diffuse == 1);
    CHECK(all.at(2).specular == 1);
    CHECK(all.at(3).diffuse == 0.98);
    CHECK(all.at(4).diffuse == 0.6);
    CHECK(all.at(4).specular == doctest::Approx(0.19));
    CHECK(all.at(5).diffuse == 0.999);
    REQUIRE(notices.size() == 3);
    CHECK(notices[0].find("lowered (blender, bright, half): 3") != std::string::npos);
    CHECK(notices[1].find("absorb nothing (white, mirror): 2") != std::string::npos);
    CHECK(notices[2].find("textures, ignored: 1") != std::string::npos);
  }

  TEST_CASE("the largest numbers of a file become shares of at most 0.98") {
    const double largest = std::numeric_limits<double>::max();
    for (const char* const albedo : {"Kd 1.7e308\n", "Kd 1.7976931348623157e308\n"})
      CHECK(material_in(albedo).diffuse == 0.98);
    CHECK(material_in("Ke 1.7976931348623157e308\n").emitted <= largest);
    const Material both = material_in("Kd 1.7e308\nKs 1.7e308\nNs 10\n");
    CHECK(both.diffuse == 0.98);
    CHECK(both.specular == 0);
  }

  TEST_CASE("comments, other capitals, other colours and numbers out of range do no harm") {
    Notices notices;
    const auto all = materials_in(
        "Ka 0 0 0\nnewmtl lamp # the lamp\nKE 1 1 1 # bright\nkd 0.25\nd 1.0001 # opaque\nnewmtl Material #25\nKd "
        "spectral a.rfl 1\n"
        "Ks xyz 1 1 1\nNs -1\nillum -1\nNi 1.5 # glass\n",
        &notices);
    CHECK(all.at(0).name == "lamp # the lamp");
    CHECK(all.at(0).emitted == 1);
    CHECK(all.at(0).diffuse == 0.25);
    CHECK(all.at(0).glass == 0);
    CHECK(all.at(1).name == "Material #25");
    CHECK(all.at(1).diffuse == 0.5);
    REQUIRE(notices.size() == 3);
    CHECK(notices[0].find("before the first newmtl, ignored: 1") != std::string::npos);
    CHECK(notices[1].find("out of range, brought into it: 3") != std::string::npos);
    CHECK(notices[2].find("ignored: 2") != std::string::npos);
  }

  TEST_CASE("a name with a comment, or with a # of its own, finds its material") {
    const ScratchFolder folder;
    (void)folder.file(
        "m.mtl",
        "newmtl a # first\nKd 0.1\nnewmtl Material #1\nKd 0.2\nnewmtl Material #2\nKd 0.3\nnewmtl Material\nKd 0.4\n");
    const std::string file =
        folder.file("m.obj",
                    "mtllib m.mtl # materials\nv 0 0 0\nv 1 0 0\nv 0 0 1\nusemtl a\nf 1 2 3\nusemtl a # again\nf 1 2 "
                    "3\nusemtl Material #1\n"
                    "f 1 2 3\nusemtl Material #2\nf 1 2 3\nusemtl Material\nf 1 2 3\nusemtl Material\u00a0\nf 1 2 3\n");
    Notices notices;
    const Mesh mesh = read_mesh(file, notices);
    const std::array<double, 6> expected{0.1, 0.1, 0.2, 0.3, 0.4, 0.4};
    for (std::size_t i = 0; i < expected.size(); ++i) CHECK(mesh.materials.of(i).diffuse == expected[i]);
    CHECK(notices.empty());
  }

  TEST_CASE("a stop request ends the matching of materials with those of the library") {
    const ScratchFolder folder;
    std::string library;
    for (int i = 0; i < 200'000; ++i) library += "newmtl " + std::to_string(i) + "\n";
    const std::string faces = "v 0 0 0\nv 1 0 0\nv 0 0 1\nusemtl 199999\nf 1 2 3\n";
    const std::string mtl = folder.file("many.mtl", library);
    const std::string obj = folder.file("many.obj", "mtllib many.mtl\n" + faces);
    Notices notices;
    const double reading = support::bounded_work_of([&] {
      (void)read_mtl(mtl, notices);
      (void)read_mesh(folder.file("alone.obj", faces), notices);
    });
    const support::StopAfterWork stop(reading + StopCheck::most_work + 1);
    CHECK_THROWS_WITH_AS((void)read_mesh(obj, notices, stop.token()), "stopped while matching materials", Stopped);
    CHECK(stop.bounded());
  }

  TEST_CASE("an OBJ file's faces have the materials of its library; the emitting ones are the scene's light") {
    const ScratchFolder folder;
    (void)folder.file("lamp.mtl", "newmtl lamp\nKd 0\nKe 3\nnewmtl wall paint\nKd 0.7 0.7 0.7\n");
    (void)folder.file("more.mtl", "newmtl more\n");
    const std::string file =
        folder.file("room.obj",
                    "mtllib lamp.mtl more.mtl\nv 0 0 0\nv 1 0 0\nv 0 0 1\nv 0 1 0\nf 1 2 4\nusemtl lamp\n"
                    "f 1 2 3\nusemtl wall paint\nf 1 3 4\nf 2 3 4\nusemtl lost\nf 3 2 1\n");
    Notices notices;
    const Mesh mesh = read_mesh(file, notices);
    CHECK(mesh.materials.of(0).diffuse == 0.5);
    CHECK(mesh.materials.of(1).emitted == 3);
    CHECK(mesh.materials.of(2).diffuse == doctest::Approx(0.7));
    CHECK(mesh.materials.of(3).diffuse == doctest::Approx(0.7));
    CHECK(mesh.materials.of(4).diffuse == 0.5);
    REQUIRE(notices.size() == 1);
    CHECK(notices[0] == "materials that no library defines, taken as matt: 1");
    const Scene scene = open_scene({.name = file, .samples = {}});
    REQUIRE(scene.lights.size() == 1);
    CHECK(kind_of(scene.lights[0]) == LightKind::surface);
    CHECK(scene.lights[0].flux == doctest::Approx(3 * 3.14159265358979 * 0.5));
    CHECK(photon_paths(scene, 100, 1).rays.size() == 100);
    const Scene other = open_scene({.name = file, .samples = {}, .lights = {LightKind::point, LightKind::spot}});
    REQUIRE(other.lights.size() == 2);
    CHECK(other.lights[1].flux == 0.5);
  }

  TEST_CASE("a library that is not there leaves all surfaces matt, with a notice") {
    const ScratchFolder folder;
    const std::string file =
        folder.file("alone.obj", "mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 0 1\nusemtl a\nf 1 2 3\n");
    Notices notices;
    CHECK(read_mesh(file, notices).materials.all.empty());
    REQUIRE(notices.size() == 1);
    CHECK(notices[0].find("gone.mtl is not there") != std::string::npos);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("numbers that cannot be read, negative and infinite colours are refused with the line") {
    const auto refuses = [](const std::string& text, const char* message) {
      CHECK_THROWS_WITH_AS((void)materials_in(text), doctest::Contains(message), FileError);
    };
    refuses("newmtl a\nKd red\n", ":2: \"red\" is not a number");
    refuses("newmtl a\nKd -1 0 0\n", ":2: must be >= 0 and finite");
    refuses("newmtl a\n\nKe\n", ":3: has too few numbers");
    refuses("newmtl a\nd nan\n", ":2: must be a number (got nan)");
    refuses("newmtl a\nKe 1e-308\n", ":2: must be 0 or at least 2.225e-308");
    refuses("newmtl a\nKe 3e-308 0 0\n", "(got 6.378e-309)");
  }
}
