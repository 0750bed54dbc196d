#include "detp/validate/choice/candidate_json.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

using namespace detp;
using Json = nlohmann::ordered_json;

TEST_SUITE("identity") {
  TEST_CASE("every candidate is read back as it was written") {
    for (const Technique technique : all_techniques)
      for (const Candidate& candidate : small_variants(technique))
        CHECK(candidate_of(technique, Json::parse(to_json(candidate).dump())) == candidate);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("names have underscores; parameters that are missing have their defaults") {
    const Candidate tree{Technique::box_tree, BoxTreeParameters{16, 64}};
    CHECK(to_json(tree) == Json{{"fan_out", 16}, {"leaf", 64}});
    CHECK(candidate_of(Technique::grid, Json::object()) == default_candidate(Technique::grid));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("unknown parameters and values of another kind or out of range are refused") {
    for (const Json& bad :
         {Json(), Json::array(), Json{{"fan_in", 2}}, Json{{"fan_out", "two"}}, Json{{"fan_out", 2.5}},
          Json{{"fan_out", nullptr}}, Json{{"fan_out", 1}}, Json{{"leaf", UINT64_MAX}}})
      CHECK_THROWS_AS(static_cast<void>(candidate_of(Technique::box_tree, bad)), std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(candidate_of(Technique::sphere_cache, Json{{"order", "random"}})),
                    std::invalid_argument);
  }
}
