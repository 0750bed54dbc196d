#include "detp/model/best_ratio.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "detp/model/predict.hpp"
#include "detp/model/sphere_cache_published.hpp"
#include "detp/model/sphere_count.hpp"
#include "support/not_a_length.hpp"
#include "support/random_workload.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Approx;
using doctest::Contains;

namespace {

constexpr std::int64_t most_spheres = 40;
const Workload typical = cube_workload(1e6, 1e5, 0.01, 2);

struct Question {
  Workload workload;
  UnitCosts costs;
};

/// Workloads on which spheres can pay: d/r0 1e-4 … 0.3, dimension 2 to 3, and costs of a machine.
std::vector<Question> questions(int number, std::uint64_t seed) {
  support::RandomNumbers random(seed);
  std::vector<Question> all;
  for (int i = 0; i < number; ++i)
    all.push_back({cube_workload(random.count(1e2, 1e8), random.count(1e2, 1e8), random.log_uniform(2e-4, 0.5), 2,
                                 random.uniform(2, 3)),
                   {.sphere_test = random.uniform(1, 5),
                    .disc_test = random.uniform(1, 10),
                    .copy = random.uniform(0, 3),
                    .rebuild = random.uniform(0, 100)}});
  return all;
}

double time(Form form, const Question& question, double ratio, std::int64_t k) {
  const auto& [w, costs] = question;
  if (form == Form::published)
    return published::rebuild_time(w, {ratio}, k, costs.sphere_test) +
           published::intersect_time(w, {ratio}, k, costs.disc_test);
  return price(predict(w, {Technique::sphere_cache, SphereCacheParameters{ratio, k}}), costs).total();
}

std::int64_t count(Form form, const Workload& w, double ratio) {
  return sphere_count(form, {ratio}, {w.disc_radius}, {w.sphere_radius});
}

/// The least time on a grid of ratios and at the steps of k, k as the form counts it.
double least_on_grid(Form form, const Question& question, int points) {
  const Workload& w = question.workload;
  std::vector<double> ratios;
  for (int i = 0; i <= points; ++i) ratios.push_back(0.02 + 0.96 * i / points);
  for (std::int64_t j = 1; j <= most_spheres; ++j) {
    const double step = step_ratio(j, {w.disc_radius}, {w.sphere_radius});
    for (const double ratio : {std::nextafter(step, 0.0), step, std::nextafter(step, 1.0)})
      if (ratio >= 0.02 && ratio <= 0.98) ratios.push_back(ratio);
  }
  double least = support::infinity;
  for (const double ratio : ratios)
    if (const std::int64_t k = count(form, w, ratio); k >= 1 && k <= most_spheres)
      least = std::min(least, time(form, question, ratio, k));
  return least;
}

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("published: no ratio of 2000, and no step of k, is faster by 1e-9") {
    for (const Question& question : questions(30, 31)) {
      const BestRatio best = best_ratio(Form::published, question.workload, question.costs);
      const double least = least_on_grid(Form::published, question, 2000);
      CHECK(best.time <= least * (1 + 1e-9));
      CHECK(best.time == time(Form::published, question, best.ratio, best.spheres));
      CHECK(best.spheres == count(Form::published, question.workload, best.ratio));
    }
  }

  TEST_CASE("corrected: no ratio of 2000, and no step of k, is faster by 1e-3") {
    for (const Question& question : questions(30, 32)) {
      const BestRatio best = best_ratio(Form::corrected, question.workload, question.costs);
      CHECK(best.time <= least_on_grid(Form::corrected, question, 2000) * (1 + 1e-3));
      CHECK(best.time == time(Form::corrected, question, best.ratio, best.spheres));
      CHECK(best.spheres == count(Form::corrected, question.workload, best.ratio));
    }
  }

  TEST_CASE("ratio and stop together: no ratio and k of a grid are faster by 0.5 %") {
    for (const Question& question : questions(15, 33)) {
      const BestRatio best = best_ratio_and_stop(question.workload, question.costs);
      double least = support::infinity;
      for (int i = 1; i < 100; ++i) {
        const double ratio = std::min(0.98, 0.02 + 0.0098 * i);
        const std::int64_t last = std::min(most_spheres, count(Form::corrected, question.workload, ratio));
        for (std::int64_t k = 1; k <= last; ++k) least = std::min(least, time(Form::corrected, question, ratio, k));
      }
      CHECK(best.time <= least * (1 + 5e-3));
      CHECK(best.time == time(Form::corrected, question, best.ratio, best.spheres));
      CHECK(best.spheres <= count(Form::corrected, question.workload, best.ratio));
    }
  }
}

TEST_SUITE("identity") {
  TEST_CASE("free to choose both, it is never slower than with k, Q or both bound") {
    for (const Question& question : questions(25, 34)) {
      const auto& [w, costs] = question;
      const double best = best_ratio_and_stop(w, costs).time * (1 - 1e-6);
      CHECK(best <= best_ratio(Form::corrected, w, costs).time);
      for (const double ratio : {0.3, 0.5, 0.65, 0.8})
        if (const BestRatio stop = best_stop(w, costs, {ratio}); stop.spheres <= most_spheres) {
          CHECK(stop.ratio == ratio);
          if (count(Form::corrected, w, ratio) >= 1) CHECK(best <= stop.time);
        }
      for (const std::int64_t k : {1, 2, 3, 5, 9, 15}) {
        const BestRatio fixed = best_ratio_for(w, costs, k);
        CHECK(fixed.spheres == k);
        if (count(Form::corrected, w, fixed.ratio) >= k) CHECK(best <= fixed.time);
      }
    }
  }

  TEST_CASE("the fastest stop is the fastest of all stops") {
    for (const Question& question : questions(20, 35))
      for (const double ratio : {0.4, 0.65, 0.9}) {
        const BestRatio best = best_stop(question.workload, question.costs, {ratio});
        for (std::int64_t k = 1; k <= std::max<std::int64_t>(1, count(Form::corrected, question.workload, ratio)); ++k)
          REQUIRE(best.time <= time(Form::corrected, question, ratio, k));
        CHECK(best.time == time(Form::corrected, question, ratio, best.spheres));
      }
  }

  TEST_CASE("the choice knows no unit of length, nor of time") {
    const UnitCosts costs{.sphere_test = 3, .disc_test = 5, .copy = 2};
    const BestRatio best = best_ratio_and_stop(typical, costs);
    for (const double scale : {1e-9, 1e9}) {
      const BestRatio scaled = best_ratio_and_stop(cube_workload(1e6, 1e5, 0.01 * scale, 2 * scale), costs);
      CHECK(scaled.spheres == best.spheres);
      CHECK(scaled.time == Approx(best.time).epsilon(1e-9));
    }
    const BestRatio slow =
        best_ratio_and_stop(typical, {.sphere_test = 3e6, .disc_test = 5e6, .step = 0, .node = 0, .copy = 2e6});
    CHECK(slow.spheres == best.spheres);
    CHECK(slow.time == Approx(1e6 * best.time).epsilon(1e-9));
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("where intersecting is all the time, the published optimum is at a step of k") {
    const Workload w = cube_workload(1e6, 1e6, 0.05, 2);
    const BestRatio best = best_ratio(Form::published, w, {.sphere_test = 1e-9, .disc_test = 1});
    CHECK(published::intersect_time(w, {best.ratio}, best.spheres, 1) == Approx(best.time).epsilon(1e-3));
    CHECK(best.ratio >= 0.02);
  }

  TEST_CASE("exactly at a tie of the published count, k and Q still belong together") {
    for (const double disc : {0x1p-2, 0x1p-4, 0x1p-6, 0x1p-10}) {
      const Workload w{.rays = 1e6, .samples = 1e3, .disc_radius = disc, .sphere_radius = 1, .box = {1, 1, 1}};
      for (const double disc_test : {1e-3, 1.0, 1e3}) {
        const BestRatio best = best_ratio(Form::published, w, {.disc_test = disc_test});
        CHECK(best.spheres == count(Form::published, w, best.ratio));
      }
    }
  }

  TEST_CASE("with many samples in a volume the best ratio is near 2/3, on surfaces near e^-1/2; and T is flat there") {
    const UnitCosts costs{.sphere_test = 1, .disc_test = 1};
    const BestRatio best = best_ratio_and_stop(cube_workload(1e6, 1e6, 0.01, 2), costs);
    CHECK(best.ratio > 0.45);
    CHECK(best.ratio < 0.75);
    CHECK(published_ratio == 0.65);
    CHECK(best_stop(cube_workload(1e6, 1e6, 0.01, 2), costs, {published_ratio}).time < 1.15 * best.time);
  }

  TEST_CASE("a disc next to as large as S0 leaves no sphere in the ratios searched") {
    const Workload w{.rays = 100, .samples = 100, .disc_radius = 0.99, .sphere_radius = 1, .box = {1, 1, 1}};
    CHECK(best_ratio_and_stop(w, {}).spheres == 0);
    CHECK(best_ratio(Form::corrected, w, {}).spheres == 0);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a disc as large as S0 or larger is refused, and a workload out of range by name") {
    for (const double disc : {1.0, 1.5}) {
      const Workload w{.rays = 100, .samples = 100, .disc_radius = disc, .sphere_radius = 1, .box = {1, 1, 1}};
      const Contains name("smaller than the sphere radius");
      CHECK_THROWS_WITH_AS((void)best_ratio(Form::published, w, {}), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)best_ratio(Form::corrected, w, {}), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)best_ratio_and_stop(w, {}), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)best_stop(w, {}, {0.5}), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)best_ratio_for(w, {}, 3), name, std::invalid_argument);
    }
    for (const double bad : support::not_a_count) {
      Workload w = typical;
      w.rays = bad;
      const Contains name("number of rays");
      CHECK_THROWS_WITH_AS((void)best_ratio(Form::published, w, {}), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)best_ratio_and_stop(w, {}), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)best_stop(w, {}, {0.5}), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)best_ratio_for(w, {}, 3), name, std::invalid_argument);
    }
  }

  TEST_CASE("a ratio or a number of spheres out of range is refused by name") {
    for (const double bad : support::not_a_ratio)
      CHECK_THROWS_WITH_AS((void)best_stop(typical, {}, {bad}), Contains("radius ratio Q"), std::invalid_argument);
    for (const std::int64_t bad : {0, -1}) {
      const Contains name("number of spheres");
      CHECK_THROWS_WITH_AS((void)best_ratio_for(typical, {}, bad), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)best_ratio(Form::published, typical, {}, bad), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)best_ratio_and_stop(typical, {}, bad), name, std::invalid_argument);
    }
  }
}
