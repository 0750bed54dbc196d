#include <doctest/doctest.h>

#include <cstring>
#include <stdexcept>

#include "detp/sim/files/disc_file.hpp"
#include "detp/sim/files/ray_file.hpp"
#include "detp/sim/files/stored_rays.hpp"
#include "support/scratch_file.hpp"

using namespace detp::sim;
using detp::support::file_error_of;
using detp::support::ScratchFolder;

namespace {

const std::vector<ColumnName> of_photons = parse_column_names("ox=px,oy=py,oz=pz,dx=-wx,dy=-wy,dz=-wz,power=flux");

std::string little(double number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

/// One photon at (1, 2, 3) that flies along (0, 0, -1), by the names of another program.
void check_photon(const RayFile& file) {
  REQUIRE(file.paths.rays.size() == 1);
  const Ray& ray = file.paths.rays[0];
  CHECK(ray.origin == glm::dvec3{1, 2, 3});
  CHECK(ray.direction == glm::dvec3{0, 0, -1});
  CHECK(ray.power == 0.5);
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("columns have the names that a user says, in every format; a minus turns the sign") {
    const ScratchFolder folder;
    const RayColumns asked{{}, of_photons};
    const std::string header =
        "element photon 1\nproperty double px\nproperty double py\nproperty double pz\nproperty "
        "double wx\nproperty double wy\nproperty double wz\nproperty double flux\nend_header\n";
    const std::vector<double> numbers{1, 2, 3, 0, 0, 1, 0.5};
    std::string bytes;
    std::string text;
    for (const double number : numbers) {
      bytes += little(number);
      text += std::to_string(number) + " ";
    }
    check_photon(read_rays(folder.file("p.csv", "flux;PX;py;pz;wx;wy;wz;n\n0,5;1;2;3;0;0;1;9\n"), {}, asked));
    check_photon(read_rays(folder.file("p.ply", "ply\nformat ascii 1.0\n" + header + text + "\n"), {}, asked));
    check_photon(read_rays(folder.file("b.ply", "ply\nformat binary_little_endian 1.0\n" + header + bytes), {}, asked));
    // Without headings columns have numbers.
    const RayColumns numbered{{}, parse_column_names("ox=1,oy=2,oz=3,dx=4,dy=5,dz=-6,power=7")};
    check_photon(read_rays(folder.file("n.csv", "1,2,3,0,0,1,0.5\n"), {}, numbered));
    std::string npy = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 7), }";
    npy.resize(117, ' ');
    npy = std::string("\x93NUMPY\x01\x00\x76\x00", 10) + npy + "\n" + bytes;
    check_photon(read_rays(folder.file("n.npy", npy), {}, numbered));
  }

  TEST_CASE("a heading that is another column's name counts as none, and is named as not used") {
    const ScratchFolder folder;
    const RayFile file = read_rays(folder.file("p.csv", "ox,oy,oz,px,dx,dy,dz,power,flux\n9,2,3,1,0,0,-1,7,0.5\n"), {},
                                   {{}, parse_column_names("ox=px,power=flux")});
    check_photon(file);
    CHECK(file.unused == std::vector<std::string>{"ox", "power"});
  }

  TEST_CASE("discs have other names, too") {
    const ScratchFolder folder;
    const auto discs = read_discs(folder.file("d.csv", "cx,cy,cz,ux,uy,uz,r\n1,2,3,0,0,1,0.5\n"), {}, {}, nullptr,
                                  parse_column_names("x=cx,y=cy,z=cz,nx=-ux,ny=-uy,nz=-uz,radius=r"));
    CHECK(discs.front().normal == glm::dvec3{0, 0, -1});
    CHECK(discs.front().radius == 0.5);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("names that a file lacks, and pairs that are none") {
    const ScratchFolder folder;
    const std::string csv = folder.file("p.csv", "px,py,pz,dx,dy,dz\n1,2,3,0,0,1\n");
    CHECK(file_error_of([&] {
            (void)read_rays(csv, {}, {{}, parse_column_names("ox=px,oy=py,oz=qz")});
          }).find("which --columns names; it has px py pz dx dy dz") != std::string::npos);
    CHECK(file_error_of([&] {
            (void)read_rays(folder.file("n.csv", "1,2,3,0,0,1\n"));
          }).find("--columns with numbers") != std::string::npos);
    for (const char* text : {"", "ox", "ox=", "=px", "ox=px,ox=py", "ox=px,oy=PX", "ox=px,"})
      CHECK_THROWS_AS_MESSAGE((void)parse_column_names(text), std::invalid_argument, text);
    CHECK(file_error_of([&] {
            (void)read_rays(folder.file("e.ply",
                                        "ply\nformat ascii 1.0\nelement a 1\nproperty float x\nelement b "
                                        "1\nproperty float x\nend_header\n1\n1\n"));
          }).find("has no element vertex or photon") != std::string::npos);
  }
}
