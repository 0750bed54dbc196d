#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/geometric.hpp>

#include "detp/sim/files/ray_file.hpp"
#include "support/packed.hpp"
#include "support/scratch_file.hpp"

using namespace detp::sim;
using detp::support::file_error_of;
using detp::support::ScratchFolder;

/// Rays as other programs write them: each file has the same two rays, or is refused with a reason.
namespace {

/// Place, direction and power, which floats can represent.
const std::vector<std::array<double, 7>> two{{0.25, -0.5, 3, 0, 0, -1, 2}, {1.5, 0, 0.125, 0, -1, 0, 0.75}};

template <class Number>
std::string as_bytes(double number, bool big = false) {
  std::string bytes(sizeof(Number), '\0');
  const auto value = static_cast<Number>(number);
  std::memcpy(bytes.data(), &value, sizeof value);
  if (big) std::ranges::reverse(bytes);
  return bytes;
}

template <class Number>
std::string all_bytes(bool big = false) {
  std::string bytes;
  for (const auto& ray : two)
    for (const double number : ray) bytes += as_bytes<Number>(number, big);
  return bytes;
}

std::string table(const std::string& heading, const std::string& separator, const std::string& front = "",
                  const std::string& line_end = "\n") {
  std::string text = heading + line_end;
  for (const auto& ray : two) {
    std::string line = front;
    for (const double number : ray) line += (line.empty() ? "" : separator) + fmt::format("{}", number);
    text += line + line_end;
  }
  return text;
}

const std::string heading = "ox,oy,oz,dx,dy,dz,power";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

std::string ply_head(const std::string& format, const std::string& element, const std::string& type,
                     const std::string& names) {
  std::string text = "ply\nformat " + format + " 1.0\ncomment a renderer\nelement " + element + " 2\n";
  std::string_view rest = names;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(','), rest.size());
    text += "property " + type + " " + std::string(rest.substr(0, end)) + "\n";
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return text + "end_header\n";
}

std::string npy(const std::string& type, const std::string& shape, const std::string& rows) {
  std::string text = "{'descr': " + type + ", 'fortran_order': False, 'shape': " + shape + ", }";
  text.resize(std::max<std::size_t>(text.size(), 400), ' ');
  text += '\n';
  return std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(text.size() % 256) +
         static_cast<char>(text.size() / 256) + text + rows;
}

/// Adaptive projection packing, as the format says.
glm::dvec3 packed_direction(const glm::dvec3& d) {
  const double inverse = 1 / d.z;  // infinite for 0
  if (std::abs(d.z) >= std::max(std::abs(d.x), std::abs(d.y))) return {d.x, d.y, d.z};
  return std::abs(d.x) >= std::abs(d.y) ? glm::dvec3{inverse, d.y, d.x} : glm::dvec3{d.x, inverse, d.y};
}

std::string mcpl(bool big, bool single, bool universal) {
  const auto whole = [&](double number) { return as_bytes<std::uint32_t>(number, big); };
  const auto real = [&](double number) {
    return single ? as_bytes<float>(number, big) : as_bytes<double>(number, big);
  };
  const std::size_t size = (universal ? 7 : 11) * (single ? 4U : 8U) + (universal ? 0 : 8);
  std::string text = std::string("MCPL003") + (big ? "B" : "L") + as_bytes<std::uint64_t>(2, big) + whole(1) +
                     whole(1) + whole(universal ? 0 : 1) + whole(universal ? 0 : 1) + whole(single ? 1 : 0) +
                     as_bytes<std::int32_t>(universal ? 22 : 0, big) + whole(static_cast<double>(size)) +
                     whole(universal ? 1 : 0);
  if (universal) text += as_bytes<double>(2, big);
  for (const std::string& part :
       {std::string("program"), std::string("a comment"), std::string("key"), std::string("blob")})
    text += whole(static_cast<double>(part.size())) + part;
  for (const auto& ray : two) {
    const glm::dvec3 packed = packed_direction({ray[3], ray[4], ray[5]});
    if (!universal) text += real(0) + real(0) + real(1);
    for (int i = 0; i < 3; ++i) text += real(ray[static_cast<std::size_t>(i)]);
    text += real(packed.x) + real(packed.y) + real(std::copysign(0.5, packed.z)) + real(7);
    if (!universal) text += real(ray[6]) + as_bytes<std::int32_t>(2112, big) + whole(9);
  }
  return text;
}

struct ForeignFile {
  const char* what;
  const char* name;
  std::string content;
  std::string columns = {};       ///< of --columns
  const char* refused = nullptr;  ///< what the message must have
};

std::vector<ForeignFile> foreign_files() {
  const std::string photon = "px,py,pz,wx,wy,wz,flux";
  const std::string by_photon = "ox=px,oy=py,oz=pz,dx=wx,dy=wy,dz=wz,power=flux";
  std::string structured = "[";
  for (const char* one : {"ox", "oy", "oz", "dx", "dy", "dz", "power"})
    structured += fmt::format("('{}', '>f8'), ", one);
  const std::string plain = table(heading, ",");
  return {{"commas", "r.csv", plain},
          {"semicolons", "r.csv", table(replaced(heading, ",", ";"), ";")},
          {"tabs", "r.tsv", table(replaced(heading, ",", "\t"), "\t")},
          {"blanks", "r.dat", table("  ox   oy oz  dx dy dz power", "   ")},
          {"headings in capitals", "r.csv", table("OX,OY,OZ,DX,DY,DZ,POWER", ",")},
          {"headings in quotes", "r.csv", table("\"ox\",\"oy\",\"oz\",\"dx\",\"dy\",\"dz\",\"power\"", ",")},
          {"headings in a comment", "r.txt", table("# ox oy oz dx dy dz power", " ")},
          {"comments before the headings", "r.csv", "# made by a tracer\n# in metres\n" + plain},
          {"decimal commas", "r.csv", replaced(table(replaced(heading, ",", ";"), ";"), ".", ",")},
          {"exponents of Fortran", "r.csv", replaced(replaced(plain, "0.25", "2.5D-01"), "1.5", "0.15D+01")},
          {"other columns", "r.csv", table("id," + heading, ",", "7")},
          {"row numbers without a heading", "r.csv", table("," + heading, ",", "0")},
          {"a line sep=", "r.csv", "sep=;\n" + table(replaced(heading, ",", ";"), ";")},
          {"a byte order mark, and line ends of DOS", "r.csv", "\xEF\xBB\xBF" + table(heading, ",", "", "\r\n")},
          {"gzip", "r.csv.gz", detp::support::packed(plain)},
          {"no headings", "r.csv", plain.substr(plain.find('\n') + 1), "ox=1,oy=2,oz=3,dx=4,dy=5,dz=6,power=7"},
          {"other names", "r.csv", table(photon, ","), by_photon},
          {"PLY as text", "r.ply",
           ply_head("ascii", "vertex", "float", heading) + replaced(table("", " "), "\n", " \n").substr(2)},
          {"PLY of photons", "p.ply", ply_head("binary_little_endian", "photon", "float", photon) + all_bytes<float>(),
           by_photon},
          {"PLY with the largest byte first", "r.ply",
           ply_head("binary_big_endian", "vertex", "double", heading) + all_bytes<double>(true)},
          {"PLY, gzip", "r.ply.gz",
           detp::support::packed(ply_head("binary_little_endian", "vertex", "double", heading) + all_bytes<double>())},
          {"an array of NumPy", "r.npy", npy("'<f4'", "(2, 7)", all_bytes<float>()),
           "ox=1,oy=2,oz=3,dx=4,dy=5,dz=6,power=7"},
          {"a structured array of NumPy", "r.npy", npy(structured + "]", "(2,)", all_bytes<double>(true))},
          {"MCPL", "r.mcpl", mcpl(false, false, false)},
          {"HDF5", "r.h5", "\x89HDF\r\n\x1a\n" + std::string(100, '\0'), {}, "is HDF5; CSV, PLY"},
          {"Parquet", "r.parquet", "PAR1" + std::string(100, '\2'), {}, "is Parquet; CSV, PLY"}};
}

void check_two(const RayFile& file, const char* what) {
  INFO(what);
  REQUIRE(file.paths.rays.size() == two.size());
  for (std::size_t i = 0; i < two.size(); ++i) {
    const auto& [x, y, z, dx, dy, dz, power] = two[i];
    const Ray& ray = file.paths.rays[i];
    CHECK(ray.origin == glm::dvec3{x, y, z});
    CHECK(glm::distance(ray.direction, {dx, dy, dz}) < 1e-15);
    CHECK(ray.power == power);
  }
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE(
      "of 26 files as other programs write them, 24 are read, and the others are refused by the name of their format") {
    const ScratchFolder folder;
    int read = 0;
    const std::vector<ForeignFile> files = foreign_files();
    REQUIRE(files.size() == 26);
    for (const ForeignFile& one : files) {
      const std::string path = folder.file(one.name, one.content);
      const RayColumns asked{{}, one.columns.empty() ? std::vector<ColumnName>{} : parse_column_names(one.columns)};
      RayFile found;
      const std::string refusal = file_error_of([&] { found = read_rays(path, {}, asked); });
      INFO(one.what, ": ", refusal);
      if (one.refused != nullptr) {
        CHECK(refusal.find(one.refused) != std::string::npos);
        continue;
      }
      REQUIRE(refusal.empty());
      check_two(found, one.what);
      ++read;
    }
    CHECK(read == 24);
  }

  TEST_CASE("MCPL in both orders of bytes, single and double, with common weight and particle, and packed") {
    const ScratchFolder folder;
    for (const bool big : {false, true})
      for (const bool single : {false, true}) {
        check_two(read_rays(folder.file("r.mcpl", mcpl(big, single, false))), "own weights");
        check_two(read_rays(folder.file("r.mcpl.gz", detp::support::packed(mcpl(big, single, false)))), "gzip");
        const RayFile common = read_rays(folder.file("u.mcpl", mcpl(big, single, true)));
        CHECK(common.paths.rays[1].power == 2);
        CHECK(common.unused == std::vector<std::string>{"energy", "ekin", "time", "pdgcode"});
        CHECK(read_rays(folder.path("u.mcpl"), {}, {{}, parse_column_names("power=energy")}).paths.rays[1].power == 1);
      }
    for (const glm::dvec3& d :
         {glm::dvec3{0.6, 0, 0.8}, {0.8, 0.6, 0}, {-0.8, 0, -0.6}, {0, -0.8, 0.6}, {1, 0, 0}, {0, 0, -1}}) {
      std::string text = mcpl(false, false, true);
      const glm::dvec3 packed = packed_direction(d);
      for (int i = 0; i < 3; ++i)
        text.replace(text.size() - 32 + 8 * static_cast<std::size_t>(i), 8,
                     as_bytes<double>(i < 2 ? packed[i] : std::copysign(0.5, packed.z)));
      CHECK(glm::distance(read_rays(folder.file("d.mcpl", text)).paths.rays[1].direction, d) < 1e-15);
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("MCPL that is damaged, and formats that are named") {
    const ScratchFolder folder;
    const auto refusal = [&](const std::string& content, const char* name = "a.mcpl") {
      return file_error_of([&] { (void)read_rays(folder.file(name, content)); });
    };
    const std::string good = mcpl(false, false, false);
    CHECK(refusal(good.substr(0, good.size() - 1)).find("ends early") != std::string::npos);
    CHECK(refusal(good.substr(0, 30)).find("ends early") != std::string::npos);
    CHECK(refusal(replaced(good, "MCPL003", "MCPL002")).find("version 002") != std::string::npos);
    CHECK(refusal("no particles").find("is no MCPL file") != std::string::npos);
    CHECK(refusal(good.substr(0, 8) + std::string(8, '\xFF') + good.substr(16)).find("1.84e+19 particles") !=
          std::string::npos);
    std::string size = good;
    size[40] = 1;
    CHECK(refusal(size).find("by its other numbers") != std::string::npos);
    CHECK(refusal(good, "a.csv").find("must end in .mcpl") != std::string::npos);
    CHECK(refusal("ply\nformat ascii 1.0\n", "a.txt").find("must end in .ply") != std::string::npos);
    CHECK(refusal("{\"ox\": 1}", "a.json").find("is JSON") != std::string::npos);
    CHECK(refusal(std::string("PK\x03\x04", 4), "a.xlsx").find(".xlsx") != std::string::npos);
  }
}
