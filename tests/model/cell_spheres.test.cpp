#include "detp/model/cell_spheres.hpp"

#include <doctest/doctest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <set>
#include <stdexcept>

#include "detp/sim/random.hpp"

using namespace detp;
using Exact = boost::multiprecision::cpp_bin_float_100;

namespace {

const Workload workload = cube_workload(1e5, 1e4, 0.01, 2);

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("8^i (1 - (1 - 8^-i)^n) in 100 digits") {
    for (const double samples : {1.0, 2.0, 1e3, 1e9, 1e18})
      for (const int level : {0, 1, 2, 5, 10, 20, 40}) {
        const Exact cells = pow(Exact{8}, level);
        const Exact expected = level == 0 ? Exact{1} : cells * (1 - pow(1 - 1 / cells, Exact{samples}));
        CHECK(abs(model::occupied_cell_spheres(samples, level) / expected - 1) < 1e-15);
      }
  }
}

TEST_SUITE("identity") {
  TEST_CASE("a child's sphere touches its parent's from inside") {
    for (int level = 0; level < 20; ++level) {
      const double outer = model::cell_sphere_radius(workload, level);
      const double inner = model::cell_sphere_radius(workload, level + 1);
      const double between = std::ldexp(2.0, -level - 1) * std::sqrt(0.75);  // of the centres
      CHECK(between + inner == doctest::Approx(outer).epsilon(1e-15));
    }
  }

  TEST_CASE("no level is plain testing; the sums are those of the levels") {
    const Counts<double> none = model::cell_sphere_counts(workload, 0);
    CHECK(none.disc_tests == workload.rays * workload.samples);
    CHECK(none.sphere_tests == 0);
    const Counts<double> one = model::cell_sphere_counts(workload, 1);
    CHECK(one.sphere_tests == doctest::Approx(8 * workload.rays).epsilon(1e-12));
    const double share = model::cell_sphere_radius(workload, 1) / workload.sphere_radius;
    CHECK(one.disc_tests == doctest::Approx(workload.samples * workload.rays * share * share).epsilon(1e-12));
  }
}

TEST_SUITE("known answer") {
  // Occupied cells of n uniform samples vary by less than √cells: 5 standard deviations at most.
  TEST_CASE("cells counted on random samples") {
    constexpr int samples = 20'000;
    for (const int level : {2, 4, 5, 6}) {
      std::set<std::uint64_t> cells;
      const double along = std::ldexp(1.0, level);
      for (std::uint64_t i = 0; i < samples; ++i) {
        const auto u = sim::uniform4(17, sim::Stream::tests, i);
        std::uint64_t cell = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) cell = cell * 1024 + static_cast<std::uint64_t>(u[axis] * along);
        cells.insert(cell);
      }
      const double expected = model::occupied_cell_spheres(samples, level);
      CHECK(std::abs(static_cast<double>(cells.size()) - expected) <= 5 * std::sqrt(expected));
      CHECK(std::abs(static_cast<double>(cells.size()) - expected) <= 0.02 * expected);
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("levels and samples out of range are refused by name") {
    CHECK_THROWS_WITH_AS((void)model::occupied_cell_spheres(10, -1), doctest::Contains("level"), std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)model::occupied_cell_spheres(0.5, 1), doctest::Contains("samples"),
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)model::cell_sphere_counts(workload, 301), doctest::Contains("level"),
                         std::invalid_argument);
    CHECK_THROWS_AS((void)model::cell_sphere_radius(Workload{}, 1), std::invalid_argument);
  }
}
