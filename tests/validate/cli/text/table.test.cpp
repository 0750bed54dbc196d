#include "detp/validate/cli/text/table.hpp"

#include <doctest/doctest.h>

#include <stdexcept>

#include "detp/validate/cli/text/words.hpp"

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

namespace detp::support {

TEST_SUITE("known answer") {
  TEST_CASE("a word is quoted only if a shell would read it otherwise") {
    CHECK(cli::shell_word("@tree") == "@tree");
    CHECK(cli::shell_word("scenes/a-b_1.obj") == "scenes/a-b_1.obj");
    CHECK(cli::shell_word("my scene.obj") == "'my scene.obj'");
    CHECK(cli::shell_word("it's") == "'it'\\''s'");
    CHECK(cli::shell_word("$(rm)") == "'$(rm)'");
    CHECK(cli::shell_word("") == "''");
  }

  TEST_CASE("ratios of times are per cent up to a factor of two, then factors") {
    CHECK(cli::as_long(1) == "as long");
    CHECK(cli::as_long(1, "grid") == "as long as grid");
    CHECK(cli::as_long(1.3) == "30 % longer");
    CHECK(cli::as_long(1.3, "grid") == "30 % longer than grid");
    CHECK(cli::as_long(0.7) == "30 % less time");
    CHECK(cli::as_long(1.994) == "99 % longer");
    CHECK(cli::as_long(2.41) == "2.41 times as long");
    CHECK(cli::as_long(2.41, "grid") == "2.41 times as long as grid");
    CHECK(cli::as_long(1234) == "1234 times as long");
    CHECK(cli::as_long(1.2e7) == "1.2e+07 times as long");
  }

  TEST_CASE("errors of predictions say which way") {
    CHECK(cli::how_far_off(1.004) == "right within 1 %");
    CHECK(cli::how_far_off(1.12) == "12 % too high");
    CHECK(cli::how_far_off(0.88) == "12 % too low");
    CHECK(cli::how_far_off(2.5) == "2.5 times too high");
    CHECK(cli::how_far_off(0.25) == "4 times too low");
    CHECK(cli::how_far_off(0.25, "too many", "too few") == "4 times too few");
  }
}

}  // namespace detp::support
