#include <doctest/doctest.h>
#include <zlib.h>

#include <cstring>

#include "detp/sim/files/disc_file.hpp"
#include "detp/sim/files/ray_file.hpp"
#include "support/packed.hpp"
#include "support/scratch_file.hpp"

using namespace detp::sim;
using detp::support::file_error_of;
using detp::support::ScratchFolder;

namespace {

std::string npy_of(const std::vector<double>& numbers, const std::string& shape, const std::string& type = "<f8") {
  std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
  header.resize(117, ' ');
  std::string bytes(8 * numbers.size(), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + "\n" + bytes;
}

std::string little(std::size_t number, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i, number /= 256) text += static_cast<char>(number % 256);
  return text;
}

/// An archive of these arrays. Local heads have no sizes, as those of numpy.
std::string zip_of(const std::vector<std::pair<std::string, std::string>>& members, bool compress = false) {
  std::string data;
  std::string entries;
  for (const auto& [name, bytes] : members) {
    const std::string packed = compress ? detp::support::packed(bytes, false) : bytes;
    const auto checksum = crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
    const std::string common = little(compress ? 8 : 0, 2) + little(0, 4) + little(checksum, 4);
    entries += "PK\x01\x02" + little(45, 2) + little(45, 2) + little(0, 2) + common + little(packed.size(), 4) +
               little(bytes.size(), 4) + little(name.size(), 2) + little(0, 12) + little(data.size(), 4) + name;
    data += "PK\x03\x04" + little(45, 2) + little(0, 2) + common + little(0xFFFFFFFF, 4) + little(0xFFFFFFFF, 4) +
            little(name.size(), 2) + little(20, 2) + name + std::string(20, '\1') + packed;
  }
  return data + entries + "PK\x05\x06" + little(0, 4) + little(members.size(), 2) + little(members.size(), 2) +
         little(entries.size(), 4) + little(data.size(), 4) + little(0, 2);
}

const std::vector<std::pair<std::string, std::string>> two_rays{{"o.npy", npy_of({0, 0, 1, 0.5, 0, 2}, "(2, 3)")},
                                                                {"d.npy", npy_of({0, 0, -1, 0, 0, -1}, "(2, 3)")},
                                                                {"length.npy", npy_of({2, 3}, "(2,)")},
                                                                {"power.npy", npy_of({1, 2, 3, 4}, "(2, 2)")},
                                                                {"made_by.npy", npy_of({0}, "()", "<U2")}};

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("arrays of an .npz are columns: vectors by their coordinates, powers in bands; stored or compressed") {
    const ScratchFolder folder;
    for (const bool compress : {false, true}) {
      const RayFile file = read_rays(folder.file("rays.npz", zip_of(two_rays, compress)));
      REQUIRE(file.paths.rays.size() == 2);
      CHECK(file.paths.rays[1].origin == glm::dvec3{0.5, 0, 2});
      CHECK(file.paths.rays[1].direction == glm::dvec3{0, 0, -1});
      CHECK(file.paths.rays[1].length == 3);
      CHECK(file.paths.rays[1].power == 3);
      CHECK(file.paths.further == std::vector<double>{2, 4});
      REQUIRE(file.bands.size() == 2);
      CHECK(file.bands[1].name == "2");
      CHECK(file.unused == std::vector<std::string>{"made_by.npy"});
    }
    const auto discs = read_discs(folder.file("discs.npz", zip_of({{"centre.npy", npy_of({1, 2, 3}, "(1, 3)")},
                                                                   {"n.npy", npy_of({0, 0, 1}, "(1, 3)")}})),
                                  0.5, {}, nullptr, parse_column_names("x=centrex,y=centrey,z=centrez"));
    CHECK(discs.front().centre == glm::dvec3{1, 2, 3});
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("archives that are none, damaged, or of arrays that do not fit together") {
    const ScratchFolder folder;
    const auto refusal = [&](const std::string& content) {
      return file_error_of([&] { (void)read_rays(folder.file("a.npz", content)); });
    };
    CHECK(refusal("no archive").find("is no ZIP archive") != std::string::npos);
    std::string damaged = zip_of(two_rays);
    damaged[200] = static_cast<char>(damaged[200] ^ 1);
    CHECK(refusal(damaged).find("damaged") != std::string::npos);
    std::string packed = zip_of(two_rays, true);
    packed[80] = static_cast<char>(packed[80] ^ 0xFF);
    CHECK(refusal(packed).find("damaged") != std::string::npos);
    CHECK(refusal(zip_of({two_rays[0]})).find("has no array dx") != std::string::npos);
    CHECK(refusal(zip_of({two_rays[0], {"d.npy", npy_of({0, 0, 1}, "(1, 3)")}})).find("of different lengths") !=
          std::string::npos);
    CHECK(refusal(zip_of({two_rays[0], {"d.npy", npy_of({0, 0, 1}, "(2, 3)")}})).find("has not all of its rows") !=
          std::string::npos);
    CHECK(refusal(zip_of({})).find("has no") != std::string::npos);
  }
}
