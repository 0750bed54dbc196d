#include "detp/sim/base/stop_check.hpp"

#include <doctest/doctest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/search/sort_pairs.hpp"
#include "support/work_log.hpp"

using namespace detp;
using namespace detp::sim;

TEST_SUITE("known answer") {
  TEST_CASE("it checks whenever most_work units have accumulated, and not before") {
    std::stop_source source;
    StopCheck check(source.get_token(), "counting");
    source.request_stop();
    CHECK_FALSE(check.requested_after(StopCheck::most_work - 1));
    CHECK(check.requested_after(1));
    CHECK(check.requested_after(0));  // it remembers the request
    CHECK_THROWS_WITH_AS(check.after(0), "stopped while counting", Stopped);
    CHECK_THROWS_AS(check.now(), Stopped);
  }

  TEST_CASE("without a stop request it never stops") {
    StopCheck check;
    check.now();
    for (int i = 0; i < 10; ++i) CHECK_FALSE(check.requested_after(StopCheck::most_work));
    std::vector<int> items(3, 1);
    int sum = 0;
    for_each_checked(std::span(items), check, [&](int item) { sum += item; });
    CHECK(sum == 3);
  }

  TEST_CASE("a loop over many items stops between pieces of them, and its work is logged") {
    std::stop_source source;
    const support::LoggedWork logged([&](std::uint64_t total) {
      if (total > 10 * StopCheck::most_work) source.request_stop();
    });
    StopCheck check(source.get_token(), "counting");
    std::vector<char> items(30 * StopCheck::most_work);
    std::uint64_t visited = 0;
    CHECK_THROWS_AS(for_each_checked(std::span(items), check, [&](char) { ++visited; }), Stopped);
    CHECK(visited == 10 * StopCheck::most_work);
    CHECK(logged.largest() == StopCheck::most_work);
  }

  TEST_CASE("pairs are sorted by ray, then disc; a stop request ends the sorting") {
    std::vector<Pair> pairs;
    for (std::uint32_t i = 0; i < 50'000; ++i) pairs.push_back({i * 7919 % 1000, i % 17});
    std::stop_source source;
    CHECK(sort_pairs(pairs, source.get_token()));
    CHECK(std::is_sorted(pairs.begin(), pairs.end()));
    source.request_stop();
    CHECK_FALSE(sort_pairs(pairs, source.get_token()));
  }

  TEST_CASE("a stopwatch counts time asleep, and restarts after a lap") {
    const Stopwatch whole;
    Stopwatch watch;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const double read = watch.seconds();
    const double lap = watch.lap();
    CHECK(read >= 0.005);
    CHECK(lap >= read);
    const double after = watch.seconds();
    CHECK(lap + after <= whole.seconds());
  }
}
