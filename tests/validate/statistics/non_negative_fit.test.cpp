#include "detp/validate/statistics/non_negative_fit.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "support/not_a_length.hpp"
#include "support/random_workload.hpp"

using namespace detp;
using doctest::Approx;
using Numbers = std::vector<double>;

namespace {

/// The problem A x = b: `a` is A row by row.
struct System {
  Numbers a;
  std::size_t unknowns;
  Numbers b;

  [[nodiscard]] double at(std::size_t row, std::size_t column) const { return a[row * unknowns + column]; }

  [[nodiscard]] Numbers rest(const Numbers& x) const {
    Numbers rest = b;
    for (std::size_t i = 0; i < b.size(); ++i)
      for (std::size_t j = 0; j < unknowns; ++j) rest[i] -= at(i, j) * x[j];
    return rest;
  }

  [[nodiscard]] double error(const Numbers& x) const {
    double squares = 0;
    for (const double r : rest(x)) squares += r * r;
    return std::sqrt(squares);
  }

  [[nodiscard]] Numbers fit() const { return validate::non_negative_fit(a, unknowns, b); }

  /// The elements of Aᵀ(b - A x), each divided by the lengths of its column of A and of b.
  [[nodiscard]] Numbers gains(const Numbers& x) const {
    const Numbers left = rest(x);
    const double length_of_b = error(Numbers(unknowns, 0));
    Numbers gains;
    for (std::size_t j = 0; j < unknowns; ++j) {
      double product = 0;
      double squares = 0;
      for (std::size_t i = 0; i < b.size(); ++i) {
        product += at(i, j) * left[i];
        squares += at(i, j) * at(i, j);
      }
      gains.push_back(product == 0 ? 0 : product / std::sqrt(squares) / length_of_b);
    }
    return gains;
  }

  void check_optimal(const Numbers& x) const {
    const Numbers gain = gains(x);
    for (std::size_t j = 0; j < unknowns; ++j) {
      CAPTURE(j);
      CHECK(x[j] >= 0);
      CHECK(gain[j] <= 1e-12);
      if (x[j] > 0) CHECK(gain[j] >= -1e-12);
    }
  }
};

void check_near(const Numbers& x, const Numbers& expected) {
  REQUIRE(x.size() == expected.size());
  for (std::size_t j = 0; j < x.size(); ++j) CHECK(x[j] == Approx(expected[j]).epsilon(1e-12));
}

System random_system(support::RandomNumbers& random) {
  System system{{}, static_cast<std::size_t>(random.whole(1, 8)), {}};
  const auto rows = static_cast<std::size_t>(random.whole(1, 12));
  for (std::size_t i = 0; i < rows; ++i) {
    system.b.push_back(random.uniform(-1, 1));
    for (std::size_t j = 0; j < system.unknowns; ++j) system.a.push_back(random.uniform(-1, 1));
  }
  return system;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a fit that is positive anyway equals least squares; an unknown of the wrong sign is 0") {
    check_near(System{{1, 0, 1, 0, 0, 1}, 2, {2, 1, 1}}.fit(), {1.5, 1});
    check_near(System{{1, 0, 0, 1}, 2, {-2, 3}}.fit(), {0, 3});
    CHECK(System{{1, 2, 3, 4}, 2, {-1, -1}}.fit() == Numbers{0, 0});
    CHECK(System{{1, 2, 3, 4}, 2, {0, 0}}.fit() == Numbers{0, 0});
  }

  TEST_CASE("an unknown that is negative in a joint fit may be positive in the end: the error is 0.117, not 0.283") {
    const System system{{4, 3, 1, 3, 4, 4, 4, 3, 1, 4, 4, 3}, 3, {1, 1, 1, 1}};
    const Numbers x = system.fit();
    check_near(x, {11. / 73, 9. / 73, 0});
    CHECK(system.error(x) == Approx(std::sqrt(1. / 73)));
    // A simpler method fits all unknowns, drops the most negative one, and fits the rest again until none is negative.
    // That method drops the first unknown first, and gets the following fit.
    CHECK(system.error({0, 0.28, 0}) == Approx(std::sqrt(0.08)));
    CHECK(system.gains({0, 0.28, 0})[0] > 0.01);
  }

  TEST_CASE("more unknowns than numbers; equal, dependent or zero columns: the error is minimal") {
    const System one{{1, 1, 2}, 3, {6}};
    CHECK(one.error(one.fit()) < 1e-12);
    const System system{{1, 1, 0, 1, 2, 2, 0, 2, 3, 3, 0, 4}, 4, {2, 4, 7}};
    const Numbers x = system.fit();
    system.check_optimal(x);
    CHECK(x[2] == 0);
    CHECK(system.error(x) < 1e-12);
  }
}

TEST_SUITE("identity") {
  TEST_CASE("random systems, one in three with dependent columns, meet the conditions of an optimum") {
    support::RandomNumbers random(12);
    for (int run = 0; run < 3000; ++run) {
      System system = random_system(random);
      if (run % 3 == 0)  // the last column becomes a copy of the first column, or a sum of two
        for (std::size_t i = 0; i < system.b.size(); ++i)
          system.a[(i + 1) * system.unknowns - 1] = system.at(i, 0) + (run % 2) * system.at(i, system.unknowns / 2);
      CAPTURE(run);
      system.check_optimal(system.fit());
    }
  }

  TEST_CASE("a column's unit does not matter, from 1e-100 to 1e100") {
    support::RandomNumbers random(13);
    for (int run = 0; run < 200; ++run) {
      const System system = random_system(random);
      System scaled = system;
      Numbers units;
      for (std::size_t j = 0; j < system.unknowns; ++j) units.push_back(random.log_uniform(1e-100, 1e100));
      for (std::size_t i = 0; i < scaled.a.size(); ++i) scaled.a[i] *= units[i % system.unknowns];
      Numbers x = scaled.fit();
      for (std::size_t j = 0; j < x.size(); ++j) x[j] *= units[j];
      CHECK(system.error(x) == Approx(system.error(system.fit())).epsilon(1e-9));
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a matrix of another size and numbers that are not finite are refused") {
    using doctest::Contains;
    CHECK_THROWS_WITH_AS((void)validate::non_negative_fit(Numbers(5), 2, Numbers(3)), Contains("got 5"),
                         std::invalid_argument);
    CHECK_THROWS_AS((void)validate::non_negative_fit({}, 0, {}), std::invalid_argument);
    for (const double bad : {support::infinity, support::not_a_number}) {
      CHECK_THROWS_WITH_AS((void)validate::non_negative_fit(Numbers{bad}, 1, Numbers{1}), Contains("finite"),
                           std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)validate::non_negative_fit(Numbers{1}, 1, Numbers{bad}), Contains("finite"),
                           std::invalid_argument);
    }
  }
}
