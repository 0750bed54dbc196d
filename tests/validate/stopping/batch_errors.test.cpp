#include "detp/validate/stopping/batch_errors.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "detp/validate/job/job.hpp"
#include "detp/validate/stopping/job_batches.hpp"

namespace detp::validate {
namespace {

sim::RunOptions with_errors() {
  sim::RunOptions options;
  options.standard_error = true;
  return options;
}

}  // namespace

TEST_SUITE("stopping") {
  TEST_CASE("standard errors of batches are those of all photons at once, and so are bounds, or larger") {
    for (const auto estimator : {sim::Estimator::disc, sim::Estimator::triangle_hits}) {
      CAPTURE(name(estimator));
      JobRequest request;
      request.scene = "@cornell";
      request.rays = 30'000;
      request.disc_radius = Length{0.05, true};
      request.keep_scene = true;
      const Job job = make_job(request);
      const auto candidate = Candidate{Technique::box_tree, BoxTreeParameters{8, 16}};
      JobSearch search(job, estimator, candidate, with_errors());
      const sim::Outcome all = search(job.paths());
      StoredBatches stored(job.paths(), job.independent_photons());
      BatchErrors errors;
      while (const auto batch = stored.next(1000)) {
        const FoundBatch found = found_batch(*batch, search(batch->rays), 0);
        errors.add(found.batch, found.outcome);
      }
      const auto photons = static_cast<double>(job.independent_photons());
      const auto sums = errors.of(all.irradiance, photons);
      REQUIRE(sums.size() == all.irradiance.size());
      std::size_t known = 0;
      std::size_t weak = 0;
      for (std::size_t i = 0; i < sums.size(); ++i) {
        CAPTURE(i);
        REQUIRE((sums[i].standard_error < sim::unbounded) == (all.standard_error[i] < sim::unbounded));
        const sim::DiscResult once{0, all.irradiance[i], all.standard_error[i], all.upper_bound[i]};
        const sim::DiscResult joined{0, all.irradiance[i], sums[i].standard_error, sums[i].upper_bound};
        if (once.standard_error < sim::unbounded) {
          ++known;
          // Here a photon that meets a disc twice has both rays in one batch.
          REQUIRE(joined.standard_error == doctest::Approx(once.standard_error).epsilon(1e-3));
        }
        if (is_weak(once)) REQUIRE(is_weak(joined));
        weak += is_weak(joined) && !is_weak(once) ? 1 : 0;
        REQUIRE(joined.upper_bound >= 0.999 * once.upper_bound);
        REQUIRE(joined.upper_bound <= 2.5 * once.upper_bound);
      }
      CHECK(known > sums.size() / 2);
      CHECK(weak < sums.size() / 10);
    }
  }

  TEST_CASE("a single photon, and none, have no standard error, but a bound; extreme powers do not vanish") {
    for (const double unit : {1.0, 1e-200, 1e200}) {
      BatchErrors errors;
      CHECK(errors.of({}, 1).empty());
      const double none = sim::unbounded;
      // Each batch has 100 photons; disc 0 is hit once, disc 1 never, disc 2 in two batches.
      sim::Outcome found_batch;
      found_batch.hits = {0, 0, 1};
      found_batch.standard_error = {none, none, none};
      found_batch.upper_bound = {3 * unit, 3 * unit, 4.744 * unit};
      errors.add({{0, 0, unit}, 100, 100}, found_batch);
      found_batch.hits = {1, 0, 1};
      found_batch.upper_bound = {4.744 * unit, 3 * unit, 4.744 * unit};
      errors.add({{unit, 0, unit}, 100, 100}, found_batch);
      const auto found = errors.of(std::vector{0.5 * unit, 0.0, unit}, 200);
      CHECK_FALSE(found[0].standard_error < none);
      CHECK(found[0].upper_bound == doctest::Approx(0.5 * unit * 4.744).epsilon(0.01));
      CHECK_FALSE(found[1].standard_error < none);
      CHECK(found[1].upper_bound == doctest::Approx(1.5 * unit).epsilon(1e-2));
      CHECK(found[2].standard_error == doctest::Approx(0.5 * std::sqrt(2) * unit).epsilon(1e-2));
      CHECK(found[2].upper_bound > unit + 2 * found[2].standard_error);
    }
  }
}

}  // namespace detp::validate
