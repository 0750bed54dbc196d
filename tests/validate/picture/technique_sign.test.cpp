#include "detp/validate/picture/labels.hpp"

#include <doctest/doctest.h>

#include <set>

using namespace detp;
using namespace detp::validate;

TEST_SUITE("identity") {
  TEST_CASE("each technique has a code of its own, each exact one also a colour of its own") {
    std::set<std::string> codes;
    std::set<std::string_view> colours;
    std::size_t exact = 0;
    for (const TechniqueRecord& record : technique_records) {
      codes.insert(code_of(record.technique));
      if (!record.exact) continue;
      colours.insert(colour_of(record.technique));
      ++exact;
    }
    CHECK(codes.size() == technique_records.size());
    CHECK(colours.size() == exact);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("codes are initials or the first two letters") {
    CHECK(code_of(Technique::box_tree) == "bt");
    CHECK(code_of(Technique::octree) == "oc");
    CHECK(code_of(Technique::sphere_cache_published) == "scp");
  }

  TEST_CASE("text is white on dark colours and black on light ones") {
    CHECK(colour_of(Technique::sphere_cache) == "#332288");
    CHECK(text_colour_on(Technique::sphere_cache) == "#ffffff");
    CHECK(text_colour_on(Technique::brute_force) == "#000000");
  }
}
