#include <doctest/doctest.h>

#include <chrono>
#include <numeric>
#include <thread>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/ranks/failures.hpp"
#include "detp/sim/ranks/farm.hpp"
#include "detp/sim/ranks/parts.hpp"
#include "thread_ranks.hpp"

using namespace detp::sim;

TEST_SUITE("ranks") {
  TEST_CASE("what fails on one rank fails on all, with its message") {
    const auto thrown = on_ranks(3, [&](Ranks& ranks) {
      do_on_all(ranks, [] {});
      do_on_all(ranks, [&] {
        if (ranks.rank() == 1) throw std::length_error("no room");
      });
    });
    CHECK_THROWS_WITH_AS(std::rethrow_exception(thrown[0]), "rank 1: no room", RankFailed);
    CHECK_THROWS_WITH_AS(std::rethrow_exception(thrown[1]), "no room", std::length_error);
    CHECK_THROWS_WITH_AS(std::rethrow_exception(thrown[2]), "rank 1: no room", RankFailed);
  }

  TEST_CASE("a rank that is stopped stops all, unless another fails") {
    const auto end = [](int failing) {
      return on_ranks(3, [&](Ranks& ranks) {
        do_on_all(ranks, [&] {
          if (ranks.rank() == 1) throw Stopped("stopped at 5 rays");
          if (ranks.rank() == failing) throw std::length_error("no room");
        });
      });
    };
    for (const std::exception_ptr& thrown : end(-1))
      CHECK_THROWS_WITH_AS(std::rethrow_exception(thrown), "stopped at 5 rays", Stopped);
    for (const std::size_t rank : {0, 1})
      CHECK_THROWS_WITH_AS(std::rethrow_exception(end(2)[rank]), "rank 2: no room", RankFailed);
  }

  TEST_CASE("a rank that fails alerts the others, which stop what they do and throw its message") {
    const auto thrown = on_ranks(3, [&](ThreadRank& ranks) {
      do_on_all(ranks, [&] {
        if (ranks.rank() == 2) throw std::length_error("no room");
        while (!ranks.alerted().stop_requested())  // ctest ends a test that waits for ever
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
        throw Stopped("stopped");
      });
    });
    for (const std::size_t rank : {0, 1})
      CHECK_THROWS_WITH_AS(std::rethrow_exception(thrown[rank]), "rank 2: no room", RankFailed);
  }

  TEST_CASE("a rank that is stopped alerts nobody: others may be at their end") {
    const auto thrown = on_ranks(2, [&](ThreadRank& ranks) {
      try {
        do_on_all(ranks, [&] {
          if (ranks.rank() == 1) throw Stopped("stopped");
        });
      } catch (const Stopped&) {
        CHECK_FALSE(ranks.alerted().stop_requested());
      }
    });
    for (const std::exception_ptr& one : thrown) CHECK_FALSE(one);
  }

  TEST_CASE("parts of an array follow one another, for any number of ranks") {
    for (const int count : {1, 2, 3, 7}) {
      const auto thrown = on_ranks(count, [&](Ranks& ranks) {
        std::vector<std::size_t> numbers(11, 99);
        const auto [first, last] = part_of(numbers.size(), ranks);
        CHECK(last - first >= 11U / static_cast<unsigned>(count));
        for (std::size_t i = first; i < last; ++i) numbers[i] = i;
        share_parts(ranks, std::span(numbers));
        for (std::size_t i = 0; i < numbers.size(); ++i) CHECK(numbers[i] == i);
      });
      for (const std::exception_ptr& one : thrown) CHECK_FALSE(one);
    }
  }

  TEST_CASE("rank 0 decides, or fails, for all") {
    const auto thrown = on_ranks(3, [&](Ranks& ranks) {
      CHECK(from_first(ranks, [&] {
              CHECK(ranks.rank() == 0);
              return std::string("octree");
            }) == "octree");
      static_cast<void>(from_first(ranks, []() -> std::string { throw std::invalid_argument("no such scene"); }));
    });
    CHECK_THROWS_WITH_AS(std::rethrow_exception(thrown[0]), "no such scene", std::invalid_argument);
    CHECK_THROWS_WITH_AS(std::rethrow_exception(thrown[2]), "rank 0: no such scene", RankFailed);
  }

  TEST_CASE("a farm gives the results of all tasks in their order, for any number of ranks") {
    const Farm::Work work = [](const std::string& task) { return task + "!"; };
    std::vector<std::string> tasks;
    for (int i = 0; i < 20; ++i) tasks.push_back(std::to_string(i));
    for (const int count : {1, 2, 3, 7, 30}) {
      const auto thrown = on_ranks(count, [&](Ranks& ranks) {
        Farm farm(ranks, work);
        if (ranks.rank() != 0) return farm.serve();
        std::vector<double> costs(tasks.size());
        std::iota(costs.begin(), costs.end(), 1.0);
        for (const std::vector<double>& given : {costs, std::vector<double>{}}) {
          const std::vector<std::string> results = farm.all(tasks, given);
          REQUIRE(results.size() == tasks.size());
          for (std::size_t i = 0; i < tasks.size(); ++i) CHECK(results[i] == tasks[i] + "!");
        }
      });
      for (const std::exception_ptr& one : thrown) CHECK_FALSE(one);
    }
  }

  TEST_CASE("a task that fails or is stopped on any rank ends the call on rank 0, and the farm goes on") {
    const Farm::Work work = [](const std::string& task) -> std::string {
      if (task == "fails") throw std::length_error("no room");
      if (task == "stops") throw Stopped("stopped");
      return task;
    };
    const auto thrown = on_ranks(2, [&](Ranks& ranks) {
      Farm farm(ranks, work);
      if (ranks.rank() != 0) return farm.serve();
      // Equal costs: rank 0 does the first and third, rank 1 the second and fourth.
      CHECK_THROWS_WITH_AS(static_cast<void>(farm.all({"a", "fails", "b", "c"})), "rank 1: no room", RankFailed);
      CHECK_THROWS_AS(static_cast<void>(farm.all({"a", "stops"})), Stopped);
      CHECK_THROWS_AS(static_cast<void>(farm.all({"fails", "b"})), std::length_error);
      CHECK(farm.all({"a", "b"}) == std::vector<std::string>{"a", "b"});
    });
    for (const std::exception_ptr& one : thrown) CHECK_FALSE(one);
  }

  TEST_CASE("a task that fails ends the others at once, on whatever rank") {
    for (const int failing : {0, 1}) {
      CAPTURE(failing);
      const auto thrown = on_ranks(3, [&](ThreadRank& ranks) {
        const Farm::Work work = [&](const std::string& task) -> std::string {
          if (task == std::to_string(failing)) throw std::length_error("no room");
          while (!ranks.alerted().stop_requested()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
          throw Stopped("stopped");
        };
        Farm farm(ranks, work);
        if (ranks.rank() != 0) return farm.serve();
        static_cast<void>(farm.all({"0", "1", "2"}));
      });
      CHECK_THROWS_WITH_AS(std::rethrow_exception(thrown[0]), failing == 0 ? "no room" : "rank 1: no room",
                           std::exception);
    }
  }

  TEST_CASE("the most expensive tasks come first, each to the rank that has least to do") {
    CHECK(ranks_for({1, 5, 3, 3}, 2) == std::vector{0, 0, 1, 1});
    CHECK(ranks_for({1, 1, 1}, 3) == std::vector{0, 1, 2});
    CHECK(ranks_for({2, 1}, 1) == std::vector{0, 0});
  }
}
