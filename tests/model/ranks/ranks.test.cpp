#include "detp/model/ranks/ranks.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

using namespace detp::model;

namespace {

SharedSearch some_search() {
  return {.rays = 3e6,
          .photons = 1e6,
          .discs = 1000,
          .photons_in_block = 1e5,
          .photon_paths = true,
          .make_seconds = 4,
          .build_seconds = 0.5,
          .search_seconds = 2};
}

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("ranks that share rays: by hand") {
    const SharedTime time = share_rays(some_search(), 4, {.bytes_per_second = 1e6, .latency = 0.01});
    CHECK(time.count == 1);
    CHECK(time.make == doctest::Approx(4 * 0.3));  // three of ten blocks
    CHECK(time.search == doctest::Approx(2 * 0.3));
    CHECK(time.build == 0.5);
    const double message = 1000 * (32 + 8 * 2 * std::log2(3));
    CHECK(time.traffic == doctest::Approx(3 * message));
    CHECK(time.collect == doctest::Approx(3 * (0.01 + message / 1e6)));
    CHECK(time.total() == doctest::Approx(time.count + time.make + time.search + time.build + time.collect));
  }

  TEST_CASE("ranks that share discs: by hand") {
    const SharedTime time = share_discs(some_search(), 4, {.bytes_per_second = 1e6, .latency = 0.01});
    CHECK(time.count == 1);
    CHECK(time.make == 4);
    CHECK(time.search == 0.5);
    CHECK(time.build == 0.125);
    CHECK(time.traffic == 3 * 250 * 20);
    CHECK(time.collect == doctest::Approx(3 * (0.01 + 250 * 20 / 1e6)));
    SharedSearch search = some_search();
    search.each_ray_seconds = 1.2;
    CHECK(share_discs(search, 4).search == doctest::Approx(1.2 + 0.8 / 4));
    CHECK(share_rays(search, 4).search == doctest::Approx(2 * 0.3));
  }
}

TEST_SUITE("reference value") {
  TEST_CASE("photon paths that are kept are not made again: by hand") {
    SharedSearch search = some_search();
    search.kept_bytes = 72 * 3e6 / 8;  // half of the rays that one of four ranks counts
    const double without = share_rays(some_search(), 4).memory;
    CHECK(share_rays(search, 4).make == doctest::Approx(4 * 0.3 / 2));
    CHECK(share_discs(search, 4).make == doctest::Approx(4 * (1 - 0.5 / 4)));
    CHECK(share_rays(search, 4).memory == doctest::Approx(without + search.kept_bytes));
    CHECK(share_rays(search, 100).make == 0);
    search.photon_paths = false;
    CHECK(share_rays(search, 4).make == doctest::Approx(4 * 0.3));
  }
}

TEST_SUITE("reference value") {
  TEST_CASE("what each ray takes: by hand") {
    using namespace detp;
    const UnitCosts costs{.cull_test = 2, .disc_test = 1, .cull = 0, .ray = 3, .streamed = 0.25};
    Prediction tree{.candidate = {Technique::box_tree, BoxTreeParameters{4, 8}},
                    .counts = {.loaded = 1e5, .cull_tests = 2e6, .culls = 1e4, .disc_tests = 1e6, .references = 1e3}};
    const double all = 1e5 * 3 + 2e6 * 2 + 1e6;
    CHECK(share_of_each_ray(tree, costs, 1e3) == doctest::Approx(1e5 * (3 + 4 * 2) / all));
    // With blocks of 2¹⁹ rays all tests of the root's children are those of long lists.
    tree.counts.loaded = 0x1p20;
    tree.counts.cull_tests = 2e7;
    tree.counts.references = 1e5;
    const double longer = 0x1p20 * 3 + 2e7 * 2 + 1e6 + 0.25 * streamed_bytes(tree.counts);
    CHECK(share_of_each_ray(tree, costs, 1e5) == doctest::Approx((0x1p20 * (3 + 4 * (2 + 0.25 * bytes_of_listed_ray)) +
                                                                  0.25 * bytes_of_ray * (0x1p20 - 0x1p17)) /
                                                                 longer));
    CHECK(share_of_each_ray({}, {}, 1) == 0);
  }
}

TEST_SUITE("identity") {
  TEST_CASE("one rank takes what one process takes, sends nothing, and counts no rays ahead; nor are lines counted") {
    SharedSearch search = some_search();
    for (const SharedTime& time : {share_rays(search, 1), share_discs(search, 1)}) {
      CHECK(time.total() == 6.5);
      CHECK(time.traffic == 0);
    }
    CHECK(share_rays(search, 2).count == 2);
    search.photon_paths = false;
    CHECK(share_rays(search, 2).count == 0);
  }

  TEST_CASE("more ranks have less to search, and with shared discs less memory; standard errors take more") {
    SharedSearch search = some_search();
    search.discs = 1e8;
    search.rays = search.photons = 1e10;
    search.photons_in_block = 0x1p23;
    for (double ranks = 1; ranks < 1000; ranks *= 2) {
      CHECK(share_rays(search, 2 * ranks).search < share_rays(search, ranks).search);
      CHECK(share_discs(search, 2 * ranks).search < share_discs(search, ranks).search);
      CHECK(share_discs(search, 2 * ranks).memory < share_discs(search, ranks).memory);
      CHECK(share_rays(search, 2 * ranks).traffic > share_rays(search, ranks).traffic);
      SharedSearch with_errors = search;
      with_errors.standard_errors = true;
      CHECK(share_rays(with_errors, ranks).memory > share_rays(search, ranks).memory);
      CHECK(share_discs(with_errors, ranks).memory > share_discs(search, ranks).memory);
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("numbers out of range are refused") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double ranks : {0.0, -1.0, 1.5, nan})
      CHECK_THROWS_AS(static_cast<void>(share_rays(some_search(), ranks)), std::invalid_argument);
    for (double SharedSearch::*const member : {&SharedSearch::rays, &SharedSearch::discs, &SharedSearch::photons,
                                               &SharedSearch::make_seconds, &SharedSearch::search_seconds}) {
      SharedSearch search = some_search();
      search.*member = -1;
      CHECK_THROWS_AS(static_cast<void>(share_discs(search, 2)), std::invalid_argument);
      search.*member = nan;
      CHECK_THROWS_AS(static_cast<void>(share_rays(search, 2)), std::invalid_argument);
    }
    CHECK_THROWS_AS(static_cast<void>(share_rays(some_search(), 2, {.bytes_per_second = 0})), std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(share_rays(some_search(), 2, {.latency = -1})), std::invalid_argument);
  }
}
