#include "detp/model/vocabulary/index_variant.hpp"

#include <doctest/doctest.h>

using namespace detp;

TEST_SUITE("known answer") {
  TEST_CASE("traversals are called as on the command line") {
    CHECK(name(Traversal::top_down) == "top-down");
    CHECK(name(Traversal::front_to_back) == "front-to-back");
    CHECK(name(Traversal::restart) == "restart");
    CHECK(name(Traversal::neighbour_links) == "neighbour-links");
  }
}

TEST_SUITE("identity") {
  TEST_CASE("a traversal is found by its name") {
    for (const Traversal traversal : all_traversals) CHECK(traversal_named(name(traversal)) == traversal);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a name that none has names none") {
    for (const char* bad : {"", "restarts", "top_down", "Restart"}) CHECK_FALSE(traversal_named(bad).has_value());
  }
}
