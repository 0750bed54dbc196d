#include "detp/model/optimum/growth.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include "detp/model/disc_index/disc_index_published.hpp"
#include "detp/model/optimum/best_published_ratio.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"
#include "support/not_a_length.hpp"

using namespace detp;
using namespace detp::model;

namespace {

/// Limits that are large enough for any index, so that memory does not decide its cells.
const SearchLimits unlimited{.most_depth = 20, .most_cells = 1e16, .most_references = 1e16};
const UnitCosts costs{};

/// A cube of side 1 with 2^{Dj} samples. Discs that shrink with the distance of the samples have powers of 2 as radius,
/// so that the depth of cells as wide as discs is always exact.
Workload workload(int j, double dimension, DiscRule disc) {
  const double samples = std::round(std::exp2(dimension * j));
  return cube_workload(1e6, samples, disc == DiscRule::fixed ? 0.2 : std::exp2(-j - 1), 1, dimension);
}

/// The power p in T ∝ n_P^p (log n_P)^q, q = `logarithms`: the slope of log(T/(log n_P)^q) over log n_P, by least
/// squares, for n_P over four decades from about 10⁸.
double fitted_power(const GrowthCase& fitted, int logarithms, const std::function<double(const Workload&)>& time) {
  const int first = fitted.dimension < 3 ? 13 : 9;
  const int last = fitted.dimension < 3 ? 20 : 14;
  double n = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  for (int j = first; j <= last; ++j) {
    const Workload at = workload(j, fitted.dimension, fitted.disc);
    const double x = std::log(at.samples);
    const double y = std::log(time(at)) - logarithms * std::log(x);
    n += 1, sum_x += x, sum_y += y, sum_xx += x * x, sum_xy += x * y;
  }
  return (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
}

double best_time(Technique technique, const Workload& at) {
  return best_of(technique, at, costs, unlimited).value().time.total();
}

void check_growth(const GrowthCase& growth_case, const std::function<double(const Workload&)>& time) {
  const Growth said = growth(growth_case);
  INFO(std::string(name(growth_case.technique)), ", D = ", growth_case.dimension,
       std::string(growth_case.disc == DiscRule::fixed ? ", d fixed" : ", d shrinks"));
  const double power = fitted_power(growth_case, said.logarithms, time);
  CAPTURE(power);
  CHECK(std::abs(power - said.power) < 0.02);
}

}  // namespace

TEST_SUITE("reference value") {
  // The fitted p deviates from the stated p by at most 0.012 (spheres on surfaces). Reasons: T = a + b n_P^p (or
  // a + b log n_P) has the lower-order term a; k and depths are whole numbers, so T has steps.
  TEST_CASE("the best time of each technique grows over four decades of samples with the stated order") {
    for (const Technique technique :
         {Technique::brute_force, Technique::sphere_cache, Technique::octree, Technique::grid})
      for (const double dimension : {2.0, 3.0})
        for (const DiscRule disc : {DiscRule::fixed, DiscRule::as_sample_distance})
          check_growth({.technique = technique, .disc = disc, .dimension = dimension},
                       [&](const Workload& at) { return best_time(technique, at); });
    check_growth({.technique = Technique::sphere_cache, .dimension = 2.5},
                 [](const Workload& at) { return best_time(Technique::sphere_cache, at); });
  }

  TEST_CASE("the published formulas grow over four decades as the paper says") {
    const auto depth = [](const Workload& at) { return published::octree_depth({at.disc_radius}, scene_side(at)); };
    for (const double dimension : {2.0, 3.0}) {
      const auto growth_case = [&](Technique technique) {
        return GrowthCase{.technique = technique, .dimension = dimension, .form = Form::published};
      };
      check_growth(growth_case(Technique::sphere_cache),
                   [](const Workload& at) { return published::best_ratio(at, costs).time; });
      check_growth(growth_case(Technique::octree),
                   [&](const Workload& at) { return published::octree_time(at, depth(at), 1); });
      check_growth(growth_case(Technique::grid),
                   [&](const Workload& at) { return published::balanced_octree_time(at, depth(at), 1); });
    }
  }

  TEST_CASE("on surfaces the paper's orders are refuted: spheres do not grow as n^(1/3), and a grid does") {
    const GrowthCase surface{.dimension = 2};
    const auto fitted = [&](Technique technique, int logarithms) {
      return fitted_power(surface, logarithms, [&](const Workload& at) { return best_time(technique, at); });
    };
    CHECK(std::abs(fitted(Technique::sphere_cache, 0) - 1.0 / 3) > 0.2);
    CHECK(std::abs(fitted(Technique::grid, 0)) > 0.2);
    // In volumes a plain octree's time has no factor log n_P: divided by log n_P, it grows more slowly than n^(1/3).
    const GrowthCase volume{};
    const auto octree = [](const Workload& at) { return best_time(Technique::octree, at); };
    CHECK(fitted_power(volume, 1, octree) < 1.0 / 3 - 0.03);
  }

  TEST_CASE("the number of spheres grows as log n_P, and has a simple pole at Q = 1") {
    const auto spheres = [](double size, double below_one) {
      return static_cast<double>(sphere_count(Form::corrected, {1 - below_one}, {size}, {1}));
    };
    CHECK(spheres(1e-8, 1e-3) / spheres(1e-4, 1e-3) == doctest::Approx(2).epsilon(1e-3));
    const double slope = std::log(spheres(1e-2, 1e-7) / spheres(1e-2, 1e-3)) / std::log(1e4);
    CHECK(slope == doctest::Approx(1).epsilon(1e-3));
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("in volumes both columns agree with the paper's abstract; without sorting nothing is gained") {
    for (const Form form : {Form::published, Form::corrected}) {
      const auto shrinking = [&](Technique technique, SampleOrder order) {
        return growth({.technique = technique, .order = order, .form = form});
      };
      CHECK(shrinking(Technique::sphere_cache, SampleOrder::lebesgue).power == doctest::Approx(1.0 / 3));
      CHECK(shrinking(Technique::octree, SampleOrder::lebesgue).power == doctest::Approx(1.0 / 3));
      CHECK(shrinking(Technique::grid, SampleOrder::lebesgue).power == doctest::Approx(1.0 / 3));
      CHECK(shrinking(Technique::sphere_cache, SampleOrder::none) == Growth{1, 0});
      CHECK(shrinking(Technique::octree, SampleOrder::lebesgue).logarithms == (form == Form::published ? 1 : 0));
    }
  }

  TEST_CASE("two thirds for volumes, 1/sqrt(e) for surfaces, a half for curves") {
    CHECK(model::optimal_ratio(3) == doctest::Approx(2.0 / 3).epsilon(1e-15));
    CHECK(model::optimal_ratio(2) == doctest::Approx(std::exp(-0.5)).epsilon(1e-15));
    CHECK(model::optimal_ratio(1) == doctest::Approx(0.5).epsilon(1e-15));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("there is an order of growth for a technique exactly if there is a closed form of its time") {
    for (const Technique technique : all_techniques)
      if (has_closed_form(technique))
        CHECK_NOTHROW((void)growth({.technique = technique}));
      else
        CHECK_THROWS_WITH_AS((void)growth({.technique = technique}), doctest::Contains("closed form"),
                             std::invalid_argument);
  }

  TEST_CASE("a dimension outside the range from surfaces to volumes is refused") {
    for (const double bad : {1.9, 3.1, std::numeric_limits<double>::quiet_NaN()})
      CHECK_THROWS_WITH_AS((void)growth({.dimension = bad}), doctest::Contains("from 2 to 3"), std::invalid_argument);
  }

  TEST_CASE("an invalid dimension is refused by name") {
    for (const double bad : support::not_a_dimension)
      CHECK_THROWS_WITH_AS((void)model::optimal_ratio(bad), doctest::Contains("dimension"), std::invalid_argument);
  }
}

TEST_SUITE("identity") {
  TEST_CASE("no other ratio gives a smaller value of the sum that it minimises") {
    for (const double dimension : {2.5, 3.0}) {
      const auto time = [&](double q) { return 1 / (q * q * (1 - std::pow(q, dimension - 2))); };
      const double best = time(model::optimal_ratio(dimension));
      for (double q = 0.01; q < 1; q += 0.001) CHECK(time(q) >= best * (1 - 1e-14));
    }
  }
}
