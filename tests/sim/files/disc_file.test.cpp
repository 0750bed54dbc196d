#include "detp/sim/files/disc_file.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "detp/sim/files/ray_file.hpp"
#include "detp/sim/files/stored_rays.hpp"
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

std::vector<Ray> read_rays_of(const std::string& name, const std::string& content) {
  const ScratchFolder folder;
  return read_rays(folder.file(name, content)).paths.rays;
}

std::string ray_error(const std::string& name, const std::string& content) {
  return support::file_error_of([&] { (void)read_rays_of(name, content); });
}

const std::string ray_ply_header =
    "ply\nformat ascii 1.0\nelement vertex 1\nproperty double ox\nproperty double oy\nproperty double oz\n"
    "property double dx\nproperty double dy\nproperty double dz\n";

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

  TEST_CASE("written rays are read back bit for bit") {
    const std::vector<Ray> rays{
        {.origin = {0.1, 2e-308, -3}, .direction = {0, 1, 0}, .length = unbounded, .power = 1},
        {.origin = {1e22, 0, 0}, .direction = glm::normalize(glm::dvec3{1, 2, 3}), .length = 0.7, .power = 1e-9}};
    const ScratchFolder folder;
    for (const char* name : {"rays.csv", "rays.ply", "rays.npy", "rays"}) {
      write_rays(folder.path(name), rays);
      const std::vector<Ray> back = read_rays(folder.path(name)).paths.rays;
      REQUIRE(back.size() == 2);
      for (std::size_t i = 0; i < 2; ++i) {
        CHECK(back[i].origin == rays[i].origin);
        CHECK(back[i].direction == rays[i].direction);
        CHECK(back[i].length == rays[i].length);
        CHECK(back[i].power == rays[i].power);
      }
    }
    CHECK_THROWS_AS(write_rays(folder.path("rays.txt"), rays), FileError);
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

  TEST_CASE("a ray without length is a line, and without power has the power 1") {
    const auto lines = read_rays_of("r.csv", "ox,oy,oz,dx,dy,dz\n1,2,3,0,0,-1e-300\n");
    CHECK(lines[0].is_line());
    CHECK(lines[0].power == 1);
    CHECK(lines[0].origin == glm::dvec3{1, 2, 3});
    CHECK(lines[0].direction == glm::dvec3{0, 0, -1});
    const auto mixed =
        read_rays_of("r.csv", "length,ox,oy,oz,dx,dy,dz\n,0,0,0,0,0,1\ninf,0,0,0,0,0,1\n2,0,0,0,0,0,9\n");
    CHECK(mixed[0].is_line());
    CHECK(mixed[1].is_line());
    CHECK(mixed[2].length == 2);  // not scaled with the direction
  }

  TEST_CASE("PLY vertices are rays") {
    const auto rays = read_rays_of("r.ply", ray_ply_header + "property double power\nend_header\n1 2 3 0 0 4 0.5\n");
    CHECK(rays[0].is_line());
    CHECK(rays[0].power == 0.5);
    CHECK(rays[0].direction == glm::dvec3{0, 0, 1});
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("an invalid disc in a CSV file is refused with its line") {
    const std::string header = "x,y,z,nx,ny,nz,radius\n0,0,0,0,0,1,1\n";
    support::check_errors(
        {{"0,0,0,0,0,0,1", ":3: the normal is zero; it needs a length"},
         {"0,0,0,0,nan,1,1", ":3: ny must be finite (got nan)"},
         {"0,inf,0,0,0,1,1", ":3: y must be finite (got inf)"},
         {"0,0,0,0,0,1,0", ":3: radius must be > 0 and finite (got 0)"},
         {"0,0,0,0,0,1,-1", ":3: radius must be > 0 and finite (got -1)"},
         {"0,0,0,0,0,1,inf", ":3: radius must be finite (got inf)"},
         {"0,0,0,0,0,1,", ":3: radius is empty; a number is needed"}},
        [&](const std::string& row) { return disc_error("d.csv", header + row + "\n"); }, "d.csv");
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

  TEST_CASE("an invalid ray in a CSV file is refused with its line") {
    const std::string header = "ox,oy,oz,dx,dy,dz,length,power\n0,0,0,0,0,1,1,1\n";
    support::check_errors(
        {{"0,0,0,0,0,0,1,1", ":3: the direction is zero; it needs a length"},
         {"0,0,0,0,0,inf,1,1", ":3: dz must be finite (got inf)"},
         {"0,nan,0,0,0,1,1,1", ":3: oy must be finite (got nan)"},
         {"0,0,0,0,0,1,0,1", ":3: length must be > 0, or inf for a line (got 0)"},
         {"0,0,0,0,0,1,-1,1", ":3: length must be > 0, or inf for a line (got -1)"},
         {"0,0,0,0,0,1,-inf,1", ":3: length must be > 0, or inf for a line (got -inf)"},
         {"0,0,0,0,0,1,nan,1", ":3: length must be > 0, or inf for a line (got nan)"},
         {"0,0,0,0,0,1,1,-1", ":3: power must be >= 0 and finite (got -1)"},
         {"0,0,0,0,0,1,1,inf", ":3: power must be finite (got inf)"},
         {"0,0,0,0,0,1,1,", ":3: power is empty; a number is needed"}},
        [&](const std::string& row) { return ray_error("r.csv", header + row + "\n"); }, "r.csv");
  }

  TEST_CASE("a file without rays is refused, and an invalid ray in a PLY file with its number") {
    CHECK(ray_error("r.csv", "ox,oy,oz,dx,dy,dz\n").find("has no ray") != std::string::npos);
    CHECK(
        ray_error("r.ply", ray_ply_header + "end_header\n1 2 3 0 0 0\n").find("vertex 1 of 1: the direction is zero") !=
        std::string::npos);
  }

  TEST_CASE("a damaged ray file is read or refused, and rays that are read are valid") {
    const auto read_sound = [](const std::string& path) {
      for (const Ray& ray : read_rays(path).paths.rays) {
        REQUIRE(std::abs(glm::length(ray.direction) - 1) < 1e-14);
        REQUIRE(ray.length > 0);
        REQUIRE(ray.power >= 0);
      }
    };
    CHECK(support::refused_when_damaged("r.csv",
                                        "ox,oy,oz,dx,dy,dz,length,power\n0,1,2,0,0,1,inf,0.5\n1,1,1,1,1,1,,1\n", 2000,
                                        read_sound) > 100);
    CHECK(support::refused_when_damaged("r.ply", ray_ply_header + "end_header\n1 2 3 0 2 0\n", 1500, read_sound) > 100);
  }
}

TEST_SUITE("photons in files") {
  TEST_CASE("photons and landings are written and read back") {
    const std::vector<Ray> rays(3, Ray{.length = 2});
    const std::vector<std::uint64_t> photons{0, 0, 1};
    const std::vector<double> landings{0.5, 1.999, unbounded};
    const ScratchFolder folder;
    for (const char* name : {"rays.csv", "rays.ply", "rays.npy"}) {
      write_rays(folder.path(name), PathRays{rays, photons, landings});
      const RayFile back = read_rays(folder.path(name));
      CHECK(back.paths.photons == photons);
      CHECK(back.paths.landings == landings);
      CHECK(back.order.empty());
    }
  }

  TEST_CASE("powers in bands are written and read back, as a whole and part by part, whatever the order of columns") {
    Paths paths;
    for (int i = 0; i < 3000; ++i) {
      paths.rays.push_back({{0.1 * i, 1, 2}, {0, 0, 1}, unbounded, 1.0 / (i + 1)});
      paths.photons.push_back(static_cast<std::uint64_t>(i / 3));
      for (const int band : {1, 2}) paths.further.push_back(std::sqrt(band + i));
    }
    paths.further_bands = 2;
    const ScratchFolder folder;
    for (const char* name : {"rays.csv", "rays.ply", "rays.npy"}) {
      CAPTURE(name);
      write_rays(folder.path(name), paths, {}, {"nir", "420.5", "uv-b"});
      const RayFile back = read_rays(folder.path(name));
      CHECK(back.bands ==
            std::vector<BandColumn>{{"nir", "power_nir"}, {"420.5", "power_420.5"}, {"uv-b", "power_uv-b"}});
      REQUIRE(back.paths.further == paths.further);
      CHECK(back.paths.rays[7].power == paths.rays[7].power);
      const auto stored = StoredRays::open(folder.path(name));
      CHECK((stored != nullptr) == (name != std::string("rays.csv")));
      if (!stored) continue;
      CHECK(stored->bands() == 3);
      std::vector<Ray> block(1000);
      BesideRays beside;
      stored->read_all(1500, block, beside);
      CHECK(std::equal(beside.further.begin(), beside.further.end(), paths.further.begin() + 3000));
    }
    const std::string mixed = folder.file(
        "m.csv", "photon,ox,oy,oz,g,dx,dy,dz,r\n1,0,0,0,20,0,0,1,2\n0,0,0,0,10,0,0,1,1\n1,0,0,0,40,0,0,1,4\n");
    const RayFile chosen = read_rays(mixed, {}, {parse_bands("red=r,green=g")});
    CHECK(chosen.paths.rays[0].power == 2);
    CHECK(chosen.paths.further == std::vector<double>{20, 40, 10});  // the photon's rays are together
    const RayFile turned = read_rays(mixed, {}, {parse_bands("green=g,red=r")});
    CHECK(turned.paths.rays[1].power == 40);
    CHECK(turned.paths.further == std::vector<double>{2, 4, 1});
  }

  TEST_CASE("bands that contradict one another are refused by name") {
    const std::string place = "ox,oy,oz,dx,dy,dz,";
    const auto refused = [&](const std::string& columns, const std::string& row, const std::string& why) {
      const std::string error = ray_error("r.csv", place + columns + "\n0,0,0,0,0,1," + row + "\n");
      CHECK_MESSAGE(error.ends_with(why), error);
    };
    refused("power,power_r", "1,2", "r.csv: has power and power_r: a file has one power or powers with names");
    refused("power_r,power_g", "1,-2", "r.csv:2: power_g must be >= 0 and finite (got -2)");
    refused("power_r,power_g", "1,inf", "r.csv:2: power_g must be finite (got inf)");
    refused("power_r,power_r", "1,2", "band 1 and band 2 have the same name");
    refused("power_", "1", "a band's name has 1 to 64 letters, digits, dots, minuses and underscores (got \"\")");
    std::string many = "power_0";
    std::string ones = "1";
    for (int band = 1; band < 65; ++band) {
      many += ",power_" + std::to_string(band);
      ones += ",1";
    }
    refused(many, ones, "65 bands are too many; the maximum is 64");
    const ScratchFolder folder;
    const std::string file = folder.file("r.csv", place + "red\n0,0,0,0,0,1,2\n");
    CHECK(support::file_error_of([&] {
            (void)read_rays(file, {}, {parse_bands("g=green")});
          }).find("the header has no column green") != std::string::npos);
    for (const char* wrong : {"", "r", "r=", "=red", "r=red,", "r=red,r=green", "r=red,g=red", "r d=red"})
      CHECK_THROWS_AS((void)parse_bands(wrong), std::invalid_argument);
  }

  TEST_CASE("photons get the numbers 0, 1, 2, … in the order of the rays; without the column there are none") {
    const ScratchFolder folder;
    const std::string header = "ox,oy,oz,dx,dy,dz,photon,landing\n";
    const RayFile file = read_rays(
        folder.file("r.csv", header + "0,0,0,0,0,1,7,1\n1,0,0,0,0,1,7,\n2,0,0,0,0,1,9,inf\n3,0,0,0,0,1,1e15,0\n"));
    CHECK(file.paths.photons == std::vector<std::uint64_t>{0, 0, 1, 2});
    CHECK(file.paths.landings == std::vector<double>{1, unbounded, unbounded, 0});
    CHECK(file.order.empty());
    const RayFile without = read_rays(folder.file("w.csv", "ox,oy,oz,dx,dy,dz\n0,0,0,0,0,1\n"));
    CHECK(without.paths.photons.empty());
    CHECK(without.paths.landings.empty());
  }

  TEST_CASE("rays of a photon that are apart are brought together, and know their places in the file") {
    const ScratchFolder folder;
    const std::string header = "ox,oy,oz,dx,dy,dz,photon\n";
    const RayFile file = read_rays(
        folder.file("r.csv", header + "0,0,0,0,0,1,5\n1,0,0,0,0,1,2\n2,0,0,0,0,1,5\n3,0,0,0,0,1,2\n4,0,0,0,0,1,3\n"));
    CHECK(file.paths.photons == std::vector<std::uint64_t>{0, 0, 1, 1, 2});
    CHECK(file.order == std::vector<std::uint32_t>{0, 2, 1, 3, 4});
    for (std::size_t i = 0; i < 5; ++i) CHECK(file.paths.rays[i].origin.x == file.order[i]);
  }

  TEST_CASE("a photon that is no whole number, and a negative landing, are refused with their line") {
    const std::string header = "ox,oy,oz,dx,dy,dz,photon,landing\n";
    support::check_errors(
        {{"0.5,1", ":2: photon must be a whole number from 0 to 2^53 (got 0.5)"},
         {"-1,1", ":2: photon must be a whole number"},
         {"1e17,1", ":2: photon must be a whole number"},
         {"nan,1", ":2: photon must be finite"},
         {"1,-1", ":2: landing must be >= 0, or inf for none (got -1)"},
         {"1,nan", ":2: landing must be >= 0, or inf for none (got nan)"}},
        [&](const std::string& row) { return ray_error("r.csv", header + "0,0,0,0,0,1," + row + "\n"); });
  }
}
