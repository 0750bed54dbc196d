#include "detp/validate/cli/text/shell_word.hpp"

#include <doctest/doctest.h>

using detp::cli::shell_word;

TEST_SUITE("known answer") {
  TEST_CASE("a word is quoted only if a shell would read it otherwise") {
    CHECK(shell_word("@tree") == "@tree");
    CHECK(shell_word("scenes/a-b_1.obj") == "scenes/a-b_1.obj");
    CHECK(shell_word("my scene.obj") == "'my scene.obj'");
    CHECK(shell_word("it's") == "'it'\\''s'");
    CHECK(shell_word("$(rm)") == "'$(rm)'");
    CHECK(shell_word("") == "''");
  }
}
