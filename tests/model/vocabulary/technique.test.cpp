#include "detp/model/vocabulary/technique.hpp"

#include <doctest/doctest.h>

#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/not_a_length.hpp"

using namespace detp;
using doctest::Contains;

namespace {

const std::vector<Parameters> one_of_each{BruteForceParameters{}, SphereCacheParameters{}, OctreeParameters{},
                                          GridParameters{},       CellSpheresParameters{}, SphereTreeParameters{},
                                          BvhParameters{},        PhotonMapParameters{},   BspParameters{}};

/// Where a technique's own parameters are in one_of_each.
std::size_t kind(Technique technique) {
  switch (technique) {
    case Technique::brute_force:
      return 0;
    case Technique::sphere_cache:
    case Technique::sphere_cache_published:
      return 1;
    case Technique::octree:
      return 2;
    case Technique::grid:
      return 3;
    case Technique::cell_spheres:
      return 4;
    case Technique::sphere_tree:
      return 5;
    case Technique::bvh:
      return 6;
    case Technique::photon_map:
      return 7;
    case Technique::bsp:
      return 8;
  }
  return one_of_each.size();
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("a technique is found by its name, which no other has") {
    std::set<std::string_view> names;
    for (const Technique technique : all_techniques) {
      CHECK(technique_named(name(technique)) == technique);
      names.insert(name(technique));
    }
    CHECK(names.size() == all_techniques.size());
  }

  TEST_CASE("an order is found by its name") {
    for (const auto order : {SampleOrder::lebesgue, SampleOrder::hilbert, SampleOrder::none})
      CHECK(order_named(name(order)) == order);
    for (const auto quality : {BuildQuality::low, BuildQuality::medium}) CHECK(quality_named(name(quality)) == quality);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("techniques and orders are called as on the command line") {
    CHECK(name(Technique::brute_force) == "brute-force");
    CHECK(name(Technique::sphere_cache) == "sphere-cache");
    CHECK(name(Technique::sphere_cache_published) == "sphere-cache-published");
    CHECK(name(Technique::cell_spheres) == "cell-spheres");
    CHECK(name(Technique::sphere_tree) == "sphere-tree");
    CHECK(name(Technique::octree) == "octree");
    CHECK(name(Technique::grid) == "grid");
    CHECK(name(Technique::bvh) == "bvh");
    CHECK(name(Technique::photon_map) == "photon-map");
    CHECK(name(BuildQuality::low) == "low");
    CHECK(name(BuildQuality::medium) == "medium");
    CHECK(name(Technique::bsp) == "bsp");
    CHECK(name(SampleOrder::lebesgue) == "lebesgue");
    CHECK(name(SampleOrder::hilbert) == "hilbert");
    CHECK(name(SampleOrder::none) == "none");
  }

  TEST_CASE("parameters are told in a few words") {
    CHECK(describe(BruteForceParameters{}).empty());
    CHECK(describe(SphereCacheParameters{0.607, 9}) == "Q 0.607, k 9");
    CHECK(describe(SphereCacheParameters{0.607, 9, SampleOrder::none}) == "Q 0.607, k 9, unsorted");
    CHECK(describe(SphereCacheParameters{0.607, 9, SampleOrder::hilbert}) == "Q 0.607, k 9, Hilbert order");
    CHECK(describe(SphereCacheParameters{0.607, 0}) == "no sphere");
    CHECK(describe(SphereCacheParameters{0.607, 0, SampleOrder::none}) == "no sphere, unsorted");
    CHECK(describe(CellSpheresParameters{5}) == "depth 5");
    CHECK(describe(SphereTreeParameters{8, 12}) == "8 a node, 12 a leaf");
    CHECK(describe(OctreeParameters{7}) == "depth 7");
    CHECK(describe(OctreeParameters{7, Traversal::neighbour_links}) == "depth 7, neighbour-links");
    CHECK(describe(BspParameters{20, 6}) == "depth 20, 6 a leaf");
    CHECK(describe(GridParameters{100}) == "100 cells a side");
    CHECK(describe(BvhParameters{BuildQuality::low}) == "low quality");
    CHECK(describe(PhotonMapParameters{20}) == "20 nearest photons");
  }

  TEST_CASE("parameters in range pass, ends included") {
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
  TEST_CASE("a name that none has names none") {
    for (const char* bad : {"", "Octree", "octree ", "sphere", "sphere_cache", "all"}) {
      CHECK_FALSE(technique_named(bad).has_value());
      CHECK_FALSE(order_named(bad).has_value());
      CHECK_FALSE(quality_named(bad).has_value());
    }
  }

  TEST_CASE("parameters of another technique are refused") {
    for (const Technique technique : all_techniques)
      for (std::size_t i = 0; i < one_of_each.size(); ++i) {
        const Candidate candidate{technique, one_of_each[i]};
        if (i == kind(technique))
          CHECK_NOTHROW(check(candidate));
        else
          CHECK_THROWS_WITH_AS(check(candidate), Contains(std::string(name(technique)).c_str()), std::invalid_argument);
      }
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
