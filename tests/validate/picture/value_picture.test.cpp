#include "detp/validate/picture/value_picture.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>

#include "support/png.hpp"
#include "support/xml.hpp"

using namespace detp::validate;
using detp::support::Pixels;
using detp::support::pixels_of;

namespace {

/// Coordinates in OKLab, from 8 bits of sRGB.
std::array<double, 3> oklab(const Colour& colour) {
  std::array<double, 3> rgb{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double part = colour[i] / 255.0;
    rgb[i] = part <= 0.04045 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4);
  }
  const double l = std::cbrt(0.4122214708 * rgb[0] + 0.5363325363 * rgb[1] + 0.0514459929 * rgb[2]);
  const double m = std::cbrt(0.2119034982 * rgb[0] + 0.6806995451 * rgb[1] + 0.1073969566 * rgb[2]);
  const double s = std::cbrt(0.0883024619 * rgb[0] + 0.2817188376 * rgb[1] + 0.6299787005 * rgb[2]);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

/// A picture of 2 × 1 pixels: the left one of four cells, the right one of one number.
ValuePanel two_pixels() {
  return {"irradiance", 2, 1, {1, no_surface, 0.5, 0.5, 0, not_known, 0.5, 0.5}, std::vector<char>(8)};
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("equal steps of a scale are equally far apart, and lighter all the way") {
    constexpr int steps = 16;
    double least = 1;
    double most = 0;
    for (int i = 0; i < steps; ++i) {
      const auto from = oklab(scale_colour(static_cast<double>(i) / steps));
      const auto to = oklab(scale_colour(static_cast<double>(i + 1) / steps));
      CHECK(to[0] > from[0] + 0.02);
      const double distance = std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
      least = std::min(least, distance);
      most = std::max(most, distance);
    }
    CHECK(most < 1.15 * least);
  }

  TEST_CASE("a scale is linear from 0 to the largest number, without the largest half percent if those stand out") {
    std::vector<double> numbers;
    for (int i = 1; i <= 1000; ++i) numbers.push_back(i);
    ColourScale scale = scale_of(numbers, Scaling::automatic);
    CHECK_FALSE(scale.logarithmic);
    CHECK(scale.low == 0);
    CHECK(scale.high == 1000);
    CHECK(scale.share(250) == 0.25);
    numbers.back() = 1e5;
    numbers.push_back(not_known);
    scale = scale_of(numbers, Scaling::automatic);
    CHECK(scale.high == doctest::Approx(995).epsilon(0.002));
    CHECK(scale.largest == 1e5);
    CHECK(scale.share(1e5) == 1);
  }

  TEST_CASE("numbers of many sizes get a logarithmic scale of at most four decades; so do others if asked") {
    std::vector<double> numbers;
    for (int i = 0; i < 1000; ++i) numbers.push_back(std::pow(10.0, -i / 100.0));
    const ColourScale scale = scale_of(numbers, Scaling::automatic);
    CHECK(scale.logarithmic);
    CHECK(scale.low == doctest::Approx(1e-4));
    CHECK(scale.share(1e-2) == doctest::Approx(0.5));
    CHECK(scale.share(0) == 0);
    CHECK(scale.ticks(7) == std::vector<double>{1e-4, 1e-3, 1e-2, 1e-1, 1});
    CHECK_FALSE(scale_of(numbers, Scaling::linear).logarithmic);
    CHECK(scale_of(std::vector<double>{3, 3, 3}, Scaling::logarithmic).low < 3);
    CHECK(scale_of({}, Scaling::logarithmic).high == 1);
  }

  TEST_CASE("a pixel is the mean of its cells, and the file says so with its checksums") {
    const Pixels picture = pixels_of(picture_png({{two_pixels()}}));
    const Colour middle = scale_colour(0.5);
    const Colour one = scale_colour(1);
    const Colour zero = scale_colour(0);
    // Cells of the first row: 1 and nothing, 0.5 and 0.5; of the second: 0 and not known, 0.5 and 0.5.
    for (std::size_t part = 0; part < 3; ++part) {
      CHECK(picture.at(16, 50)[part] == (one[part] + 255 + zero[part] + 190 + 2) / 4);
      CHECK(picture.at(17, 50)[part] == middle[part]);
    }
    CHECK(picture.at(0, 0) == Colour{255, 255, 255});
  }

  TEST_CASE("a cell at the edge of a surface is half as light") {
    ValuePanel panel = two_pixels();
    panel.outlines = {0, 0, 1, 1, 0, 0, 1, 1};
    const Pixels picture = pixels_of(picture_png({{panel}}));
    CHECK(picture.at(17, 50)[1] == scale_colour(0.5)[1] / 2);
  }

  TEST_CASE("as SVG: titles, numbers of the bar, and the same pixels") {
    ValuePanel panel = two_pixels();
    panel.title = "light & shade";
    panel.scale = {0, 6000, false, 7654};
    const std::string svg = picture_svg({{panel}, {panel}}, "<scene>");
    CHECK(detp::support::is_well_formed(svg));
    CHECK(detp::support::count_of(svg, "light &amp; shade (largest 7.65e+03)") == 2);
    for (const char* part : {"&lt;scene&gt;", ">0<", ">2000<", ">6000<", "data:image/png;base64,iVBORw0KGgo"})
      CHECK_MESSAGE(svg.find(part) != std::string::npos, part);
  }

  TEST_CASE("base64, the vectors of RFC 4648") {
    CHECK(base64("").empty());
    CHECK(base64("f") == "Zg==");
    CHECK(base64("fo") == "Zm8=");
    CHECK(base64("foo") == "Zm9v");
    CHECK(base64("foobar") == "Zm9vYmFy");
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a picture needs panels, all of one size") {
    CHECK_THROWS_AS(static_cast<void>(picture_png({})), std::invalid_argument);
    ValuePanel other = two_pixels();
    other.cells.pop_back();
    CHECK_THROWS_AS(static_cast<void>(picture_png({{two_pixels(), other}})), std::invalid_argument);
  }
}
