#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/files/disc_file.hpp"
#include "detp/sim/files/npy_header.hpp"
#include "detp/sim/files/ray_file.hpp"
#include "support/scratch_file.hpp"

using namespace detp;
using namespace detp::sim;
using support::ScratchFolder;

namespace {

/// A file as numpy.save writes it.
std::string npy(const std::string& description, const std::string& rows, int version = 1) {
  std::string header = description + std::string(53, ' ') + "\n";
  std::string file = "\x93NUMPY";
  file += static_cast<char>(version);
  file += '\0';
  for (std::size_t i = 0, length = header.size(); i < (version == 1 ? 2U : 4U); ++i, length /= 256)
    file += static_cast<char>(length % 256);
  return file + header + rows;
}

template <class Number>
std::string bytes(Number number, bool big = false) {
  auto text = std::bit_cast<std::array<char, sizeof(Number)>>(number);
  if (big != (std::endian::native == std::endian::big)) std::ranges::reverse(text);
  return {text.data(), text.size()};
}

template <class Number>
std::string bytes_of(std::initializer_list<double> numbers, bool big = false) {
  std::string text;
  for (const double number : numbers) text += bytes(static_cast<Number>(number), big);
  return text;
}

RayFile npy_rays(const std::string& content) {
  const ScratchFolder folder;
  return read_rays(folder.file("rays.npy", content));
}

std::string npy_error(const std::string& content) {
  return support::file_error_of([&] { static_cast<void>(npy_rays(content)); });
}

const std::string plain_row = bytes_of<double>({1, 2, 3, 0, 0, 2});

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("an array of NumPy is read: plain or structured, in any order of bytes, with any types and fields") {
    const auto check = [](const RayFile& file) {
      REQUIRE(file.paths.rays.size() == 2);
      CHECK(file.paths.rays[0].origin == glm::dvec3{1, 2, 3});
      CHECK(file.paths.rays[0].direction == glm::dvec3{0, 0, 1});
      CHECK(file.paths.rays[1].origin == glm::dvec3{4, 5, 6});
      CHECK(file.paths.rays[1].direction == glm::dvec3{0, 1, 0});
    };
    for (const bool big : {false, true}) {
      const std::string rows = bytes_of<float>({1, 2, 3, 0, 0, 1, 4, 5, 6, 0, 3, 0}, big);
      check(npy_rays(
          npy(fmt::format("{{'descr': '{}f4', 'fortran_order': False, 'shape': (2, 6), }}", big ? ">" : "<"), rows)));
    }
    const RayFile with_length =
        npy_rays(npy("{'descr': '<f8', 'fortran_order': False, 'shape': (1, 7), }", plain_row + bytes_of<double>({5})));
    CHECK(with_length.paths.rays[0].length == 5);
    for (const int version : {1, 2, 3}) {
      std::string rows;
      for (const auto& [photon, x, y, z, dy, dz] : {std::array<double, 6>{7, 1, 2, 3, 0, 1}, {9, 4, 5, 6, 1, 0}}) {
        rows += bytes(static_cast<std::int64_t>(photon)) + "skip" + bytes_of<float>({dz, dy, 0});
        rows += bytes_of<double>({x, y}) + bytes(static_cast<std::int16_t>(z), true) + bytes(std::uint8_t{1});
      }
      const RayFile file = npy_rays(
          npy("{\"descr\": [('photon', '<i8'), ('', '|V4'), ('dz', '<f4'), ('dy', '<f4'), ('dx', '<f4'), ('ox', "
              "'<f8'), ('oy', '<f8'), ('oz', '>i2'), ('mine', '|u1')], 'fortran_order': False, 'shape': (2,)}",
              rows, version));
      check(file);
      CHECK(file.paths.photons == std::vector<std::uint64_t>{0, 1});
    }
    const ScratchFolder folder;
    const auto discs =
        read_discs(folder.file("discs.npy", npy("{'descr': '<f8', 'fortran_order': False, 'shape': (1, 7), }",
                                                bytes_of<double>({1, 2, 3, 0, 0, 1, 0.5}))),
                   {});
    CHECK(discs.at(0).radius == 0.5);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("an array that cannot be rays is refused with what is wrong") {
    const std::string good = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 6), }";
    const auto with = [&](const std::string& from, const std::string& to) {
      std::string changed = good;
      return npy(changed.replace(changed.find(from), from.size(), to), plain_row);
    };
    CHECK(npy_rays(npy(good, plain_row)).paths.rays.size() == 1);
    const std::vector<std::pair<std::string, std::string>> cases{
        {"ox,oy,oz\n", "is no NumPy file"},
        {npy(good, plain_row).substr(0, 9), "NumPy"},
        {npy(good, plain_row).substr(0, 40), "ends in its header"},
        {npy(good, plain_row.substr(1)), "ends early"},
        {with("(1, 6)", "(1, 5)"), "has no column dz"},
        {with("(1, 6)", "(1, 11)"), "11 columns"},
        {with("(1, 6)", "(0, 6)"), "has no ray"},
        {with("(1, 6)", "(6,)"), "two are needed"},
        {with("(1, 6)", "(1, 2, 3)"), "two are needed"},
        {with("(1, 6)", "(99999999999999999999, 6)"), "whole numbers"},
        {with("(1, 6)", "(4611686018427387904, 6)"), "ends early"},
        {with("False", "True"), "Fortran"},
        {with("False", "Maybe"), "neither True nor False"},
        {with("'<f8'", "'<c16'"), "type \"<c16\""},
        {with("'<f8'", "'<f2'"), "type \"<f2\""},
        {with("'<f8'", "[('ox', '<f8', (3,))]"), "an array in the field \"ox\""},
        {with("'<f8'", "[('ox', [('x', '<f8')])]"), "fields in the field \"ox\""},
        {with("'<f8'", "[('ox', '<f8')]"), "has a structured array of 2 dimensions"},
        {with("'shape'", "'size'"), "unknown key \"size\""},
        {with("'descr'", "'descr"), "header"},
        {with("}", ""), "header"},
        {npy("{}", ""), "no type"},
        {npy(good, bytes_of<double>({1, 2, 3, 0, 0, 0})), "row 1 of 1: the direction is zero"},
        {npy(good, bytes_of<double>({1, NAN, 3, 0, 0, 1})), "row 1 of 1: oy must be finite"}};
    support::check_errors(cases, npy_error);
  }

  TEST_CASE("of several bad rows, the first is named, whichever thread reads it") {
    constexpr std::size_t count = 100'000;
    std::string rows;
    for (std::size_t i = 0; i < count; ++i) rows += i % 30'000 == 20'000 ? std::string(48, '\0') : plain_row;
    const std::string file =
        npy(fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, 6), }}", count), rows);
    for (int i = 0; i < 5; ++i) CHECK(npy_error(file).find("row 20001 of 100000") != std::string::npos);
  }
}
