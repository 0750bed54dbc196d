#include "detp/validate/cli/text/words.hpp"

#include <doctest/doctest.h>

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
