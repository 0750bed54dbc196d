#include "detp/sim/files/disc_file.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "support/scratch_file.hpp"

using namespace detp;
using namespace detp::sim;
using support::ScratchFolder;

namespace {

std::vector<Disc> read_discs_of(const std::string& name, const std::string& content,
                                std::optional<double> radius = {}) {
  const ScratchFolder folder;
  return read_discs(folder.file(name, content), radius);
}

std::string disc_error(const std::string& name, const std::string& content, std::optional<double> radius = {}) {
  return support::file_error_of([&] { (void)read_discs_of(name, content, radius); });
}

const std::string disc_ply_header =
    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
    "property float nx\nproperty float ny\nproperty float nz\n";

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("written discs are read back bit for bit") {
    const std::vector<Disc> discs{
        {.centre = {0.1, -1.0 / 3, 1e-300}, .normal = {0, 0, 1}, .radius = 0.01},
        {.centre = {1e300, 5e-324, 0}, .normal = glm::normalize(glm::dvec3{0.3, -0.7, 0.11}), .radius = 1e-17}};
    const ScratchFolder folder;
    for (const char* name : {"discs.csv", "discs.ply", "discs", "DISCS.PLY"}) {
      write_discs(folder.path(name), discs);
      const std::vector<Disc> back = read_discs(folder.path(name), std::nullopt);
      REQUIRE(back.size() == 2);
      for (std::size_t i = 0; i < 2; ++i) {
        CHECK(back[i].centre == discs[i].centre);
        CHECK(back[i].normal == discs[i].normal);
        CHECK(back[i].radius == discs[i].radius);
      }
    }
    CHECK_THROWS_AS(write_discs(folder.path("discs.xyz"), discs), FileError);
    CHECK(support::content_of(folder.path("discs")) == support::content_of(folder.path("discs.csv")));
    CHECK(support::content_of(folder.path("discs.ply")).starts_with("ply\nformat binary_little_endian"));
    CHECK(support::content_of(folder.path("discs.csv")).starts_with("x,y,z,nx,ny,nz,radius\n0.1,-0.333"));
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("normals of any length are scaled to 1") {
    const auto discs = read_discs_of("d.csv", "radius,nz,ny,nx,z,y,x\n2,1e-300,0,0,3,2,1\n2,0,-3e300,4e300,0,0,0\n");
    CHECK(discs[0].normal == glm::dvec3{0, 0, 1});
    CHECK(discs[0].centre == glm::dvec3{1, 2, 3});
    CHECK(glm::length(discs[1].normal - glm::dvec3{0.8, -0.6, 0}) < 1e-15);
  }

  TEST_CASE("the default radius applies if the file has none") {
    CHECK(read_discs_of("d.csv", "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n", 0.5)[0].radius == 0.5);
    const auto discs = read_discs_of("d.csv", "x,y,z,nx,ny,nz,radius\n0,0,0,0,0,1,\n0,0,0,0,0,1,2\n", 0.5);
    CHECK(discs[0].radius == 0.5);
    CHECK(discs[1].radius == 2);
  }

  TEST_CASE("PLY vertices are discs, other properties are skipped") {
    const std::string extra = "property float radius\nproperty list uchar int extra\nend_header\n";
    const auto discs = read_discs_of("d.PLY", disc_ply_header + extra + "1 2 3 0 2 0 4 1 7\n");
    REQUIRE(discs.size() == 1);
    CHECK(discs[0].centre == glm::dvec3{1, 2, 3});
    CHECK(discs[0].normal == glm::dvec3{0, 1, 0});
    CHECK(discs[0].radius == 4);
    CHECK(read_discs_of("d.ply", disc_ply_header + "end_header\n1 2 3 0 2 0\n", 0.25)[0].radius == 0.25);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("an invalid disc in a CSV file is refused with its line") {
    const std::string header = "x,y,z,nx,ny,nz,radius\n0,0,0,0,0,1,1\n";
    for (const auto& [bound_row, reason] : {std::pair{"0,0,0,0,0,0,1", ":3: the normal is zero; it needs a length"},
                                            {"0,0,0,0,nan,1,1", ":3: ny must be finite (got nan)"},
                                            {"0,inf,0,0,0,1,1", ":3: y must be finite (got inf)"},
                                            {"0,0,0,0,0,1,0", ":3: radius must be > 0 and finite (got 0)"},
                                            {"0,0,0,0,0,1,-1", ":3: radius must be > 0 and finite (got -1)"},
                                            {"0,0,0,0,0,1,inf", ":3: radius must be finite (got inf)"},
                                            {"0,0,0,0,0,1,", ":3: radius is empty; a number is needed"}}) {
      const auto& row = bound_row;
      CAPTURE(row);
      const std::string message = disc_error("d.csv", header + row + "\n");
      CHECK_MESSAGE(message.find(std::string("d.csv") + reason) != std::string::npos, message);
    }
  }

  TEST_CASE("a file without discs, or without a radius anywhere, is refused") {
    CHECK(disc_error("d.csv", "x,y,z,nx,ny,nz,radius\n").find("has no disc") != std::string::npos);
    CHECK(disc_error("d.csv", "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n").find("no column radius, and no default") !=
          std::string::npos);
    CHECK(
        disc_error("d.ply", disc_ply_header + "end_header\n1 2 3 0 2 0\n").find("no property radius, and no default") !=
        std::string::npos);
    CHECK(disc_error("d.csv", "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n", -1).find("radius must be > 0") != std::string::npos);
  }

  TEST_CASE("an invalid disc in a PLY file is refused with its number") {
    const std::string message = disc_error("d.ply", disc_ply_header + "end_header\n1 2 3 0 0 0\n", 1);
    CHECK_MESSAGE(message.find("d.ply: vertex 1 of 1: the normal is zero") != std::string::npos, message);
  }

  TEST_CASE("a damaged disc file is read or refused, and discs that are read are valid") {
    const auto read_sound = [](const std::string& path) {
      for (const Disc& disc : read_discs(path, 1.0)) {
        REQUIRE(std::abs(glm::length(disc.normal) - 1) < 1e-14);
        REQUIRE(disc.radius > 0);
        REQUIRE(std::isfinite(disc.radius));
      }
    };
    CHECK(support::refused_when_damaged("d.csv", "x,y,z,nx,ny,nz,radius\n0,1,2,0,0,1,0.5\n0.1,0,0,1e-9,0,0,1e9\n", 2000,
                                        read_sound) > 100);
    CHECK(support::refused_when_damaged("d.ply", disc_ply_header + "end_header\n1 2 3 0 2 0\n", 1500, read_sound) >
          100);
  }
}
