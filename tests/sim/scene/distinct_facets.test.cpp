#include "detp/sim/scene/facet.hpp"

#include <doctest/doctest.h>

#include <array>

#include "detp/sim/geometry/random.hpp"

using namespace detp::sim;

TEST_SUITE("identity") {
  TEST_CASE("of triangles with the same corners, in any order, at most six facets remain, under their first numbers") {
    std::array<glm::dvec3, 3> corners{{{0, 0, 0}, {0.5, 0.1, 0}, {0.2, 0.7, -0.3}}};
    std::vector<Facet> all;
    std::array<std::size_t, 3> order{0, 1, 2};
    for (int i = 0; i < 600; ++i) {
      all.push_back(make_facet(corners[order[0]], corners[order[1]], corners[order[2]]));
      all.push_back(make_facet(corners[0], corners[0], corners[1]));  // without area
      std::next_permutation(order.begin(), order.end());
    }
    const DistinctFacets distinct = distinct_facets(all);
    CHECK(distinct.triangles == std::vector<std::uint32_t>{0, 2, 4, 6, 8, 10});
    REQUIRE(distinct.facets.size() == 6);
    REQUIRE(distinct.places.size() == all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
      CHECK(distinct.places[i] == (i % 2 == 1 ? no_facet : static_cast<std::uint32_t>(i / 2 % 6)));
  }

  TEST_CASE("facets that differ in one bit all remain") {
    std::vector<Facet> all;
    for (std::uint64_t i = 0; i < 1000; ++i) {
      const auto random = uniform4(1, Stream::tests, i);
      const glm::dvec3 corner{random[0], random[1], random[2]};
      for (const double x : {0.5, std::nextafter(0.5, 1.0)})
        all.push_back(make_facet(corner, corner + glm::dvec3{x, 0, 0}, corner + glm::dvec3{0, random[3] + 0.1, 0.3}));
    }
    const DistinctFacets distinct = distinct_facets(all);
    std::size_t twins = 0;  // rounding of the edges may make two facets of a pair equal
    for (std::size_t i = 0; i < all.size(); i += 2) twins += all[i].first == all[i + 1].first ? 1 : 0;
    CHECK(twins < 900);
    CHECK(distinct.facets.size() == all.size() - twins);
  }
}
