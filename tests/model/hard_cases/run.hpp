#pragma once

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <mpfr.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <thread>
#include <vector>

#include "draw.hpp"
#include "ledger.hpp"

/// Runs a check on many random inputs, on all cores, and compares the ledger with the allowed error.
namespace detp::hard_cases {

inline constexpr std::uint64_t few = 2'000;       ///< in the quick suite
inline constexpr std::uint64_t many = 1'000'000;  ///< in the suite "hard-cases"

/// Calls check(draw, ledger) for the inputs 0 … inputs - 1 of a family. Rethrows an exception of check.
template <class Check>
[[nodiscard]] Ledger on_random_inputs(std::uint64_t family, std::uint64_t inputs, const Check& check) {
  const std::uint64_t threads = std::min<std::uint64_t>(std::max(1U, std::thread::hardware_concurrency()), inputs);
  std::vector<Ledger> ledgers(threads);
  std::vector<std::exception_ptr> thrown(threads);
  std::vector<std::thread> running;
  for (std::uint64_t thread = 0; thread < threads; ++thread)
    running.emplace_back([&, thread] {
      try {
        for (std::uint64_t i = thread; i < inputs; i += threads) {
          Draw draw(family, i);
          check(draw, ledgers[thread]);
        }
      } catch (...) {
        thrown[thread] = std::current_exception();
      }
      mpfr_free_cache();  // MPFR keeps constants for each thread
    });
  for (std::thread& thread : running) thread.join();
  Ledger all;
  for (std::uint64_t thread = 0; thread < threads; ++thread) {
    if (thrown[thread]) std::rethrow_exception(thrown[thread]);
    all.merge(ledgers[thread]);
  }
  return all;
}

/// Fails the test, and shows the inputs, if an error is larger than allowed.
inline void require_right(const Ledger& ledger) {
  REQUIRE(!ledger.entries().empty());
  CHECK_MESSAGE(ledger.failures() == 0, ledger.report());
}

/// Fails the test if an error is larger than allowed, and prints the table to standard output; for the long suite.
inline void require_right_and_print(const Ledger& ledger) {
  fmt::print("{}", ledger.table());
  require_right(ledger);
}

}  // namespace detp::hard_cases
