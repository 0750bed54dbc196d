#include "detp/model/vocabulary/counts.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <set>
#include <string_view>
#include <vector>

using namespace detp;

namespace {

/// Powers of two, so that each sum shows which terms are in it.
template <class T>
Counts<T> powers() {
  Counts<T> counts;
  T value = 1;
  for_each_term(counts, [&](std::string_view, T& term) {
    term = value;
    value *= 2;
  });
  return counts;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("each term is visited once, under its own name, and no term is missing") {
    std::set<std::string_view> names;
    std::vector<double> values;
    for_each_term(powers<double>(), [&](std::string_view name, double term) {
      names.insert(name);
      values.push_back(term);
    });
    CHECK(names.size() == 16);
    CHECK(values.size() == 16);
    CHECK(sizeof(Counts<double>) == 16 * sizeof(double));
    CHECK(values.back() == 32768);
  }

  TEST_CASE("an observation converts to the same numbers") {
    CHECK(as_expected(powers<std::uint64_t>()) == powers<double>());
    CHECK(as_expected(Counts<std::uint64_t>{}) == Counts<double>{});
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("tests are tests of spheres, boxes and discs together") {
    CHECK(tests(Counts<std::uint64_t>{.cull_tests = 3, .disc_tests = 4, .steps = 100}) == 7);
  }
}
