#include "detp/validate/cli/text/table.hpp"

#include <doctest/doctest.h>

#include <stdexcept>

namespace detp::cli {
namespace {

TextTable example() {
  TextTable table({{.head = "technique", .align = Align::left},
                   {.head = "tests", .spare = 1, .group = "predicted"},
                   {.head = "seconds", .group = "predicted"},
                   {.head = "why", .align = Align::left, .spare = 2},
                   {.head = "never"}});
  table.add({{"grid"}, {"12"}, {"0.5 ± 0.1"}, {"few cells"}});
  table.add({{"octree"}, {"1234567"}, {"1"}});
  return table;
}

}  // namespace

TEST_SUITE("identities") {
  TEST_CASE("columns line up under their heads and groups; empty columns are not shown") {
    CHECK(example().text(Screen{}) ==
          "           predicted\n"
          "technique    tests    seconds  why\n"
          "grid            12  0.5 ± 0.1  few cells\n"
          "octree     1234567          1\n");
  }

  TEST_CASE("a table that is too wide leaves out what can be spared, most of all first, and says so") {
    CHECK(example().text(Screen{.width = 40}) == example().text(Screen{}));
    CHECK(example().text(Screen{.width = 35}) ==
          "           predicted\n"
          "technique    tests    seconds\n"
          "grid            12  0.5 ± 0.1\n"
          "octree     1234567          1\n"
          "(left out of 35 columns: why; a\n wider terminal or --format csv\n shows all)\n");
    CHECK(example()
              .text(Screen{.width = 20})
              .starts_with("           predicted\n"
                           "technique    seconds\n"
                           "grid       0.5 ± 0.1\n"
                           "octree             1\n"));
    CHECK(example().text(Screen{.width = 20}).find("predicted tests;") != std::string::npos);
  }

  TEST_CASE("styles do not move columns") {
    TextTable table({{.head = "a"}, {.head = "b"}});
    table.add({{"1", Style::good}, {"2"}});
    CHECK(table.text(Screen{.colour = true}) == "\033[1ma\033[0m  \033[1mb\033[0m\n\033[32m1\033[0m  2\n");
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a row of more cells than columns is refused") {
    TextTable table({{.head = "a"}});
    CHECK_THROWS_AS(table.add({{"1"}, {"2"}}), std::logic_error);
  }
}

}  // namespace detp::cli
