#include "detp/model/vocabulary/quoted.hpp"

#include <doctest/doctest.h>

#include <array>

namespace detp {

TEST_SUITE("identities") {
  TEST_CASE("the edit distance counts letters inserted, left out, replaced and swapped") {
    CHECK(edit_distance("", "") == 0);
    CHECK(edit_distance("octree", "octree") == 0);
    CHECK(edit_distance("", "grid") == 4);
    CHECK(edit_distance("chose", "choose") == 1);
    CHECK(edit_distance("chooose", "choose") == 1);
    CHECK(edit_distance("choise", "choose") == 1);
    CHECK(edit_distance("cohose", "choose") == 1);
    CHECK(edit_distance("kitten", "sitting") == 3);
  }

  TEST_CASE("the edit distance is the same in both directions") {
    CHECK(edit_distance("octree", "tree-box") == edit_distance("tree-box", "octree"));
    CHECK(edit_distance("a", "grid") == edit_distance("grid", "a"));
  }

  TEST_CASE("the nearest name is suggested where it is near, and nothing else") {
    constexpr std::array<std::string_view, 4> names{"octree", "box-tree", "grid", "sphere-tree"};
    CHECK(did_you_mean("octre", names) == "; did you mean octree?");
    CHECK(did_you_mean("boxtree", names) == "; did you mean box-tree?");
    CHECK(did_you_mean("gird", names) == "; did you mean grid?");
    CHECK(did_you_mean("quadtree", names).empty());
    CHECK(did_you_mean("", names).empty());
    CHECK(did_you_mean("x", names).empty());
    CHECK(did_you_mean("octree", {}).empty());
    CHECK(did_you_mean(std::string(100'000, 'o'), names).empty());
  }
}

}  // namespace detp
