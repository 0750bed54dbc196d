#include "detp/validate/cli/text/text_blocks.hpp"

#include <doctest/doctest.h>

using namespace detp::cli;

namespace {

const std::vector<TextBlock> test_blocks{{{"", "1", "22"}}, {{"a", "bb", "c"}}, {{"A", "BBBB", "C"}}};

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("blocks stand side by side if they fit, else below, each time with the first block") {
    CHECK(side_by_side(test_blocks, {}) == "    a   A\n1   bb  BBBB\n22  c   C\n\n");
    CHECK(side_by_side(test_blocks, {.width = 12}) == side_by_side(test_blocks, {}));
    CHECK(side_by_side(test_blocks, {.width = 11}) == "    a\n1   bb\n22  c\n\n    A\n1   BBBB\n22  C\n\n");
  }

  TEST_CASE("blocks are too wide if one of them does not fit beside the first") {
    CHECK_FALSE(is_too_wide(test_blocks, {}));
    CHECK_FALSE(is_too_wide(test_blocks, {.width = 8}));
    CHECK(is_too_wide(test_blocks, {.width = 7}));
  }
}
