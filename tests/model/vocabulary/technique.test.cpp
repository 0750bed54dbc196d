#include "detp/model/vocabulary/technique.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/not_a_length.hpp"

using namespace detp;
using doctest::Contains;

TEST_SUITE("identity") {
  TEST_CASE("each technique has a name of its own and is found by it") {
    std::set<std::string_view> names;
    for (const Technique technique : all_techniques) {
      CHECK(technique_named(name(technique)) == technique);
      names.insert(name(technique));
    }
    CHECK(names.size() == all_techniques.size());
  }

  TEST_CASE("a choice is found by its name") {
    for (const auto order : {SampleOrder::lebesgue, SampleOrder::hilbert, SampleOrder::none})
      CHECK(choice_named<SampleOrder>(name(order)) == order);
    for (const auto quality : {BuildQuality::low, BuildQuality::medium})
      CHECK(choice_named<BuildQuality>(name(quality)) == quality);
    for (const auto traversal :
         {Traversal::top_down, Traversal::front_to_back, Traversal::restart, Traversal::neighbour_links})
      CHECK(choice_named<Traversal>(name(traversal)) == traversal);
  }

  TEST_CASE("a parameter that was set is read back by its name; its default and small value are in range") {
    for (const TechniqueRecord& record : technique_records) {
      Candidate candidate = default_candidate(record.technique);
      CHECK_NOTHROW(check(candidate));
      for (const Parameter& parameter : record.parameters) {
        CAPTURE(parameter.name);
        set_parameter(candidate, parameter.name, parameter.small);
        CHECK(parameter.get(candidate.parameters) == parameter.small);
        CHECK(find_parameter(record.technique, parameter.name) == &parameter);
        CHECK_FALSE(parameter.help.empty());
      }
      CHECK_NOTHROW(check(candidate));
    }
  }

  TEST_CASE("small variants: each choice, each number at its minimum, no duplicates, all in range") {
    for (const TechniqueRecord& record : technique_records) {
      const std::vector<Candidate> variants = small_variants(record.technique);
      for (std::size_t i = 0; i < variants.size(); ++i) {
        CHECK_NOTHROW(check(variants[i]));
        for (std::size_t j = 0; j < i; ++j) CHECK_FALSE(variants[i] == variants[j]);
      }
      for (const Parameter& parameter : record.parameters)
        for (const std::string_view choice : parameter.choices)
          CHECK(std::any_of(variants.begin(), variants.end(), [&](const Candidate& variant) {
            return parameter.get(variant.parameters) == ParameterValue{choice};
          }));
    }
    CHECK(small_variants(Technique::octree).size() == 5);
    CHECK(small_variants(Technique::brute_force).size() == 1);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("techniques and orders have the names of the command line") {
    CHECK(name(Technique::brute_force) == "brute-force");
    CHECK(name(Technique::sphere_cache) == "sphere-cache");
    CHECK(name(Technique::sphere_cache_published) == "sphere-cache-published");
    CHECK(name(Technique::cell_spheres) == "cell-spheres");
    CHECK(name(Technique::sphere_tree) == "sphere-tree");
    CHECK(name(Technique::octree) == "octree");
    CHECK(name(Technique::grid) == "grid");
    CHECK(name(Technique::bvh) == "bvh");
    CHECK(name(Technique::photon_map) == "photon-map");
    CHECK(name(Technique::box_tree) == "box-tree");
    CHECK(name(BuildQuality::low) == "low");
    CHECK(name(BuildQuality::medium) == "medium");
    CHECK(name(Technique::bsp) == "bsp");
    CHECK(name(SampleOrder::lebesgue) == "lebesgue");
    CHECK(name(SampleOrder::hilbert) == "hilbert");
    CHECK(name(SampleOrder::none) == "none");
  }

  TEST_CASE("parameters are described in a few words") {
    const auto words = [](Technique technique, const Parameters& parameters) {
      return describe({technique, parameters});
    };
    CHECK(describe(Candidate{}).empty());
    CHECK(words(Technique::sphere_cache, SphereCacheParameters{0.607, 9}) == "Q 0.607, k 9");
    CHECK(words(Technique::sphere_cache, SphereCacheParameters{0.607, 9, SampleOrder::none}) ==
          "Q 0.607, k 9, order none");
    CHECK(words(Technique::cell_spheres, CellSpheresParameters{5}) == "depth 5");
    CHECK(words(Technique::sphere_tree, SphereTreeParameters{8, 12}) == "fan-out 8, leaf 12");
    CHECK(words(Technique::box_tree, BoxTreeParameters{4, 64}) == "fan-out 4, leaf 64");
    CHECK(words(Technique::octree, OctreeParameters{7}) == "depth 7");
    CHECK(words(Technique::octree, OctreeParameters{7, Traversal::neighbour_links}) ==
          "depth 7, traversal neighbour-links");
    CHECK(words(Technique::bsp, BspParameters{20, 6}) == "depth 20, leaf 6");
    CHECK(words(Technique::grid, GridParameters{100}) == "cells 100");
    CHECK(words(Technique::bvh, BvhParameters{BuildQuality::low}) == "quality low");
    CHECK(words(Technique::photon_map, PhotonMapParameters{20}) == "nearest 20");
  }

  TEST_CASE("parameters in range are accepted, including the ends") {
    for (const Technique technique : {Technique::sphere_cache, Technique::sphere_cache_published})
      for (const std::int64_t k : {0LL, 1LL, 9LL, 9'000'000'000'000'000'000LL})
        CHECK_NOTHROW(check(Candidate{technique, SphereCacheParameters{0.5, k}}));
    for (const int depth : {0, 20}) CHECK_NOTHROW(check(Candidate{Technique::octree, OctreeParameters{depth}}));
    for (const int depth : {0, 16})
      CHECK_NOTHROW(check(Candidate{Technique::cell_spheres, CellSpheresParameters{depth}}));
    for (const auto& tree : {SphereTreeParameters{2, 1}, SphereTreeParameters{1048576, 1048576}})
      CHECK_NOTHROW(check(Candidate{Technique::sphere_tree, tree}));
    for (const int cells : {1, 1048576}) CHECK_NOTHROW(check(Candidate{Technique::grid, GridParameters{cells}}));
    for (const int nearest : {3, 1'000'000'000})
      CHECK_NOTHROW(check(Candidate{Technique::photon_map, PhotonMapParameters{nearest}}));
    for (const auto& tree : {BspParameters{0, 1}, BspParameters{64, 1048576}})
      CHECK_NOTHROW(check(Candidate{Technique::bsp, tree}));
    CHECK_NOTHROW(check(Candidate{}));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("an unknown name gives nothing") {
    for (const char* bad : {"", "Octree", "octree ", "sphere", "sphere_cache", "all"}) {
      CHECK_FALSE(technique_named(bad).has_value());
      CHECK_FALSE(choice_named<SampleOrder>(bad).has_value());
      CHECK_FALSE(choice_named<BuildQuality>(bad).has_value());
    }
  }

  TEST_CASE("parameters of another technique are refused") {
    for (const TechniqueRecord& record : technique_records)
      for (const TechniqueRecord& other : technique_records) {
        const Candidate candidate{record.technique, other.defaults};
        if (other.defaults.index() == record.defaults.index())
          CHECK_NOTHROW(check(candidate));
        else
          CHECK_THROWS_WITH_AS(check(candidate), Contains(std::string(record.name).c_str()), std::invalid_argument);
      }
  }

  TEST_CASE("setting a parameter that the technique does not have, or a value out of range, is refused") {
    Candidate grid = default_candidate(Technique::grid);
    CHECK_THROWS_WITH_AS(set_parameter(grid, "depth", std::int64_t{3}), Contains("depth is no parameter of grid"),
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS(set_parameter(grid, "cells", std::int64_t{0}), Contains("cells a side"),
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS(set_parameter(grid, "cells", std::int64_t{1} << 40), Contains("cells a side"),
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS(set_parameter(grid, "cells", 0.5), Contains("cells a side"), std::invalid_argument);
    Candidate octree = default_candidate(Technique::octree);
    CHECK_THROWS_WITH_AS(set_parameter(octree, "traversal", std::string_view{"sideways"}),
                         Contains("top-down, front-to-back"), std::invalid_argument);
    CHECK(grid == default_candidate(Technique::grid));
    CHECK(octree == default_candidate(Technique::octree));
  }

  TEST_CASE("parameters out of range are refused by name") {
    for (const Technique technique : {Technique::sphere_cache, Technique::sphere_cache_published}) {
      for (const double bad : support::not_a_ratio)
        CHECK_THROWS_WITH_AS(check(Candidate{technique, SphereCacheParameters{bad, 3}}), Contains("radius ratio Q"),
                             std::invalid_argument);
      for (const std::int64_t bad : {-1LL, 9'100'000'000'000'000'000LL})
        CHECK_THROWS_WITH_AS(check(Candidate{technique, SphereCacheParameters{0.5, bad}}),
                             Contains("number of spheres"), std::invalid_argument);
    }
    for (const int bad : {-1, 21})
      CHECK_THROWS_WITH_AS(check(Candidate{Technique::octree, OctreeParameters{bad}}), Contains("depth"),
                           std::invalid_argument);
    for (const int bad : {-1, 17})
      CHECK_THROWS_WITH_AS(check(Candidate{Technique::cell_spheres, CellSpheresParameters{bad}}), Contains("depth"),
                           std::invalid_argument);
    for (const int bad : {1, 0, -2, 1048577})
      CHECK_THROWS_WITH_AS(check(Candidate{Technique::sphere_tree, SphereTreeParameters{bad, 4}}), Contains("fan-out"),
                           std::invalid_argument);
    for (const int bad : {0, -1, 1048577})
      CHECK_THROWS_WITH_AS(check(Candidate{Technique::sphere_tree, SphereTreeParameters{4, bad}}),
                           Contains("samples in a leaf"), std::invalid_argument);
    for (const int bad : {2, 0, -50, 1'000'000'001})
      CHECK_THROWS_WITH_AS(check(Candidate{Technique::photon_map, PhotonMapParameters{bad}}), Contains("nearest"),
                           std::invalid_argument);
    for (const int bad : {0, -5, 1048577})
      CHECK_THROWS_WITH_AS(check(Candidate{Technique::grid, GridParameters{bad}}), Contains("cells a side"),
                           std::invalid_argument);
    for (const int bad : {-1, 65})
      CHECK_THROWS_WITH_AS(check(Candidate{Technique::bsp, BspParameters{bad, 4}}), Contains("depth"),
                           std::invalid_argument);
    for (const int bad : {0, -1, 1048577})
      CHECK_THROWS_WITH_AS(check(Candidate{Technique::bsp, BspParameters{8, bad}}), Contains("discs in a leaf"),
                           std::invalid_argument);
  }
}
