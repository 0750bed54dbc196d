#include <doctest/doctest.h>

#include "detp/validate/picture/value_picture.hpp"
#include "support/command.hpp"
#include "support/png.hpp"
#include "support/run_support.hpp"
#include "support/xml.hpp"

namespace detp {
namespace {

using support::check_refused;
using support::detp;
using support::pixels_of;
using support::ScratchFolder;
using support::words;
using validate::scale_colour;

// The upper left corner of the first panel, of 800 × 600 pixels.
constexpr std::uint32_t left = 16;
constexpr std::uint32_t top = 50;

TEST_SUITE("known answer") {
  TEST_CASE("a picture has the colours of the discs' irradiance where the discs are") {
    const ScratchFolder folder;
    const std::string discs =
        folder.file("discs.csv", "x,y,z,nx,ny,nz,radius\n-1,0,0,0,0,1,0.5\n1,0,0,0,0,1,0.5\n1,1.5,0,0,0,1,0.4\n");
    const std::string rays = folder.file(
        "rays.csv",
        "ox,oy,oz,dx,dy,dz\n-1,0,1,0,0,-1\n1,0,1,0,0,-1\n1,0.1,1,0,0,-1\n1,-0.1,1,0,0,-1\n1.1,0,1,0,0,-1\n");
    const std::string file = folder.path("p.png");
    // From z = 10 the picture is 8 high and 10.67 wide.
    const auto found =
        detp(words("run --discs " + discs + " --ray-file " + rays + " --picture " + file + " --view 0,0,10,0,0,0"));
    REQUIRE_MESSAGE(found.code == 0, found.err);
    const support::Pixels picture = pixels_of(support::content_of(file));
    const auto at = [&](double x, double y) {
      return picture.at(left + static_cast<std::uint32_t>(400 + 75 * x),
                        top + static_cast<std::uint32_t>(300 - 75 * y));
    };
    CHECK(at(-1, 0.02) == scale_colour(0.25));
    CHECK(at(1, 0.02) == scale_colour(1));
    CHECK(at(1, 1.52) == scale_colour(0));
    CHECK(at(0, 0) == validate::Colour{255, 255, 255});
    CHECK(found.out.find("picture   " + file) != std::string::npos);
  }

  TEST_CASE(
      "with standard errors there is a panel of these, and with bands a row for each; the same on any number of "
      "threads") {
    const ScratchFolder folder;
    const auto png = [&](const std::string& options) {
      const std::string file = folder.path("p.png");
      const auto found = detp(words("run @cornell --rays 3000 --samples 500 --quiet --picture " + file + options));
      REQUIRE_MESSAGE(found.code == 0, found.err);
      return support::content_of(file);
    };
    const std::string one = png(" --threads 1");
    CHECK(pixels_of(png(" --picture-width 400")).width < 600);
    CHECK(one == png(" --threads 3"));
    const support::Pixels plain = pixels_of(one);
    const support::Pixels errors = pixels_of(png(" --standard-error --bands rgb"));
    CHECK(errors.width - 16 == 2 * (plain.width - 16));
    CHECK(errors.height - 16 == 3 * (plain.height - 16));
  }

  TEST_CASE("as SVG a picture says what it shows") {
    const ScratchFolder folder;
    const std::string file = folder.path("p.svg");
    REQUIRE(detp(words("run @furnace --rays 3000 --standard-error --picture-scale log --picture " + file)).code == 0);
    const std::string svg = support::content_of(file);
    CHECK(support::is_well_formed(svg));
    CHECK(support::count_of(svg, "<image") == 2);
    for (const char* part : {"<title>Irradiance in @furnace</title>", ">irradiance", ">relative error"})
      CHECK_MESSAGE(svg.find(part) != std::string::npos, part);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("pictures are of one run and one view, in a format that is known") {
    const ScratchFolder folder;
    const std::string file = folder.path("p.png");
    check_refused({{"run @cornell --view 1,2,3,4,5,6", "give --picture FILE"},
                   {"run @cornell --picture-scale log", "give --picture FILE"},
                   {"run @cornell --rays 100 --view 1,2,3 --picture " + file, "--view takes six numbers"},
                   {"run @cornell --rays 100 --view 1,2,3,1,2,3 --picture " + file, "from one place to another"},
                   {"run @cornell --rays 100,200 --picture " + file, "are of one run"},
                   {"run @cornell --picture " + folder.path("p.jpg"), "--picture writes .png, .svg"}});
  }
}

}  // namespace
}  // namespace detp
