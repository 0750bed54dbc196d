#include "detp/model/optimum/best_published_ratio.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"
#include "detp/model/sphere_cache/step_pieces.hpp"
#include "support/not_a_length.hpp"
#include "support/random_workload.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Approx;
using doctest::Contains;

namespace {

struct PublishedQuestion {
  Workload workload;
  UnitCosts costs;
};

/// Random workloads with d/r₀ 1e-4 … 0.3, and costs t and u that differ by up to a factor of a thousand.
std::vector<PublishedQuestion> published_questions(int number) {
  support::RandomNumbers random(41);
  std::vector<PublishedQuestion> all;
  for (int i = 0; i < number; ++i)
    all.push_back({cube_workload(random.count(1e2, 1e8), random.count(1, 1e8), random.log_uniform(2e-4, 0.7), 2),
                   {.cull_test = random.log_uniform(1e-2, 10), .disc_test = random.log_uniform(1e-2, 10)}});
  return all;
}

double time(const PublishedQuestion& question, double ratio, std::int64_t k) {
  return published::rebuild_time(question.workload, {ratio}, k, question.costs.cull_test) +
         published::intersect_time(question.workload, {ratio}, k, question.costs.disc_test);
}

std::int64_t published_count(const Workload& w, double ratio) {
  return sphere_count(Form::published, {ratio}, {w.disc_radius}, {w.sphere_radius});
}

/// The smallest time over a grid of ratios, with k from the paper's formula.
double least_on_grid(const PublishedQuestion& question, int points) {
  double least = support::infinity;
  for (int i = 0; i <= points; ++i) {
    const double ratio = least_ratio + (most_ratio - least_ratio) * i / points;
    const std::int64_t k = published_count(question.workload, ratio);
    if (k >= 1 && k <= 40) least = std::min(least, time(question, ratio, k));
  }
  return least;
}

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("the best published number of spheres has the smallest T of all numbers") {
    for (const PublishedQuestion& question : published_questions(300))
      for (const double ratio : {0.1, 0.5, 0.65, 0.9, 0.99}) {
        const std::int64_t last = published_count(question.workload, ratio);
        const std::int64_t stop = published::best_stop(question.workload, question.costs, {ratio});
        double least = support::infinity;
        for (std::int64_t k = 1; k <= last; ++k) least = std::min(least, time(question, ratio, k));
        INFO("ratio ", ratio, ", stop ", stop, ", last ", last);
        CHECK(stop >= 1);
        CHECK(stop <= last);
        CHECK(time(question, ratio, stop) == Approx(least).epsilon(1e-12));
      }
  }

  TEST_CASE("for a disc as large as S0 the best published number of spheres is zero") {
    Workload workload = cube_workload(100, 100, 0.1, 1);
    workload.sphere_radius = 0.1;
    CHECK(published::best_stop(workload, {}, {0.5}) == 0);
  }
}

TEST_SUITE("reference value") {
  TEST_CASE("no ratio of 5000 is faster, none is below the bound, and the bound is within 1e-9") {
    for (const PublishedQuestion& question : published_questions(40)) {
      const published::BestRatio best = published::best_ratio(question.workload, question.costs);
      const double least = least_on_grid(question, 5000);
      CAPTURE(best.ratio);
      CHECK(best.time <= least * (1 + 1e-9));
      CHECK(best.lower_bound <= least * (1 + 1e-12));
      CHECK(best.lower_bound >= best.time * (1 - 1e-9));
      CHECK(best.lower_bound <= best.time);
      CHECK(best.time == time(question, best.ratio, best.spheres));
      CHECK(best.spheres == published_count(question.workload, best.ratio));
    }
  }

  TEST_CASE("control: a ratio 5 % away is slower than the bound allows") {
    const PublishedQuestion question{cube_workload(1e6, 1e5, 0.01, 2), {}};
    const published::BestRatio best = published::best_ratio(question.workload, question.costs);
    for (const double off : {0.95, 1.05})
      CHECK(time(question, off * best.ratio, published_count(question.workload, off * best.ratio)) >
            best.lower_bound * (1 + 1e-6));
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("if intersecting takes all the time, k spheres as small as the interval allows are best") {
    const Workload w = cube_workload(1e6, 1e6, 0.05, 2);
    const published::BestRatio best = published::best_ratio(w, UnitCosts{.cull_test = 1e-9, .disc_test = 1});
    CHECK(published::intersect_time(w, {best.ratio}, best.spheres, 1) == Approx(best.time).epsilon(1e-3));
  }

  TEST_CASE("if d/r0 is a power of two, k and Q still belong together") {
    for (const double disc : {0x1p-2, 0x1p-4, 0x1p-6, 0x1p-10})
      for (const double disc_test : {1e-3, 1.0, 1e3}) {
        const Workload w{.rays = 1e6, .samples = 1e3, .disc_radius = disc, .sphere_radius = 1, .box = {1, 1, 1}};
        const published::BestRatio best = published::best_ratio(w, UnitCosts{.disc_test = disc_test});
        CHECK(best.spheres == published_count(w, best.ratio));
      }
  }

  TEST_CASE("a disc almost as large as S0 has one sphere, at the upper end of the ratios") {
    const Workload w{.rays = 100, .samples = 100, .disc_radius = 0.99, .sphere_radius = 1, .box = {1, 1, 1}};
    const published::BestRatio best = published::best_ratio(w, {});
    CHECK(best.spheres == 1);
    CHECK(best.ratio <= most_ratio);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a disc as large as S0, a workload and a number of spheres out of range are refused by name") {
    for (const double disc : {1.0, 1.5}) {
      const Workload w{.rays = 100, .samples = 100, .disc_radius = disc, .sphere_radius = 1, .box = {1, 1, 1}};
      CHECK_THROWS_WITH_AS((void)published::best_ratio(w, {}), Contains("smaller than the sphere radius"),
                           std::invalid_argument);
    }
    const Workload typical = cube_workload(1e6, 1e5, 0.01, 2);
    for (const double bad : support::not_a_count) {
      Workload w = typical;
      w.rays = bad;
      CHECK_THROWS_WITH_AS((void)published::best_ratio(w, {}), Contains("number of rays"), std::invalid_argument);
    }
    for (const std::int64_t bad : {0, -1})
      CHECK_THROWS_WITH_AS((void)published::best_ratio(typical, {}, bad), Contains("number of spheres"),
                           std::invalid_argument);
  }
}
