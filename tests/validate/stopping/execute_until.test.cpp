#include "detp/validate/stopping/execute_until.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "detp/validate/job/job.hpp"
#include "detp/validate/stopping/batch_errors.hpp"
#include "detp/validate/stopping/job_batches.hpp"

namespace detp::validate {
namespace {

Job job_of(const char* scene, double rays) {
  JobRequest request;
  request.scene = scene;
  request.rays = rays;
  request.disc_radius = Length{0.05, true};
  request.keep_scene = true;
  return make_job(request);
}

sim::RunOptions with_errors() {
  sim::RunOptions options;
  options.standard_error = true;
  return options;
}

}  // namespace

TEST_SUITE("stopping") {
  TEST_CASE("batches of stored rays split no photon, lose none, and each estimates the whole") {
    const Job job = job_of("@cornell", 4000);
    for (const std::uint64_t wanted : {1ULL, 97ULL, 100'000ULL}) {
      CAPTURE(wanted);
      StoredBatches stored(job.paths(), job.independent_photons());
      std::size_t rays = 0;
      double photons = 0;
      double sum_of_shares = 0;
      while (const auto batch = stored.next(wanted)) {
        const auto& numbers = batch->rays.photons;
        REQUIRE(numbers.size() == batch->rays.rays.size());
        REQUIRE(numbers.data() == job.photons.data() + rays);
        rays += numbers.size();
        CHECK((rays == job.rays.size() || job.photons[rays] != numbers.back()));
        photons += batch->photons;
        sum_of_shares += 1 / batch->scale;
      }
      CHECK(rays == job.rays.size());
      CHECK(photons == static_cast<double>(job.independent_photons()));
      CHECK(sum_of_shares == doctest::Approx(1));
    }
  }

  TEST_CASE("photons drawn in random order: all of them, with their rays; another seed draws others first") {
    Job job = job_of("@cornell", 4000);
    std::vector<double> firsts;
    for (const std::uint64_t seed : {5ULL, 6ULL}) {
      StoredBatches stored(job.paths(), job.independent_photons(), seed);
      std::vector<double> origins;
      double photons = 0;
      while (const auto batch = stored.next(97)) {
        REQUIRE(batch->rays.rays.size() == batch->rays.landings.size());
        check(*batch);
        CHECK(batch->rays.photon_count == static_cast<std::uint64_t>(batch->photons));
        for (const sim::Ray& ray : batch->rays.rays) origins.push_back(ray.origin.x);
        photons += batch->photons;
      }
      CHECK(photons == static_cast<double>(job.independent_photons()));
      firsts.push_back(origins.front());
      std::vector<double> all;
      for (const sim::Ray& ray : job.rays) all.push_back(ray.origin.x);
      std::ranges::sort(all);
      std::ranges::sort(origins);
      CHECK(origins == all);
    }
    CHECK(firsts[0] != firsts[1]);
    // Going on after a batch.
    StoredBatches whole(job.paths(), job.independent_photons(), 5);
    const auto first = whole.next(500);
    StoredBatches later(job.paths(), job.independent_photons(), 5);
    later.skip(static_cast<std::uint64_t>(first->photons), first->rays.rays.size());
    CHECK(later.next(10)->rays.rays.front().origin == whole.next(10)->rays.rays.front().origin);
    // A run may have had more rays than are stored.
    StoredBatches in_order(job.paths(), job.independent_photons());
    in_order.skip(1'000'000, 1'000'000);
    CHECK(in_order.at_end());
    CHECK_FALSE(in_order.next(10));
  }

  TEST_CASE("a random order has each number once, and no place is special") {
    for (const std::uint64_t count : {1ULL, 2ULL, 3ULL, 1000ULL, 4097ULL}) {
      std::vector<char> seen(count);
      const RandomOrder order(count, 3);
      for (std::uint64_t i = 0; i < count; ++i) {
        REQUIRE(order[i] < count);
        CHECK(!seen[order[i]]);
        seen[order[i]] = 1;
      }
    }
    // The mean of the first hundred of a thousand, over many seeds: 499.5 with a standard error of 8.7/√200.
    double sum = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed)
      for (std::uint64_t i = 0; i < 100; ++i) sum += static_cast<double>(RandomOrder(1000, seed)[i]) / 100 / 200;
    CHECK(std::abs(sum - 499.5) < 4 * 27.4 / std::sqrt(200.0));
  }

  TEST_CASE("the irradiance of a plan that is executed until an error is that of one search of the same rays") {
    const Job job = job_of("@cornell", 30'000);
    const Plan planned = plan(job.discs, job.rays);
    StoredBatches stored(job.paths(), job.independent_photons());
    const ExecutedUntil found = execute_until(planned, [&](std::uint64_t rays) { return stored.next(rays); },
                                              weights_by_area(job.discs), {.error = 0.001}, {.first_rays = 10'000});
    CHECK(found.result.reason == StopReason::rays);
    CHECK(found.result.rays == job.rays.size());
    sim::SearchScratch scratch;
    const sim::Outcome& whole = execute(planned, job.paths(), scratch);
    CHECK(found.outcome.hits == whole.hits);
    for (std::size_t disc = 0; disc < whole.irradiance.size(); ++disc)
      REQUIRE(found.result.irradiance[disc] == doctest::Approx(whole.irradiance[disc]).epsilon(1e-9));
    const auto weights = weights_by_area(job.discs);
    CHECK(std::accumulate(weights.begin(), weights.end(), 0.0) == doctest::Approx(1));
  }

  TEST_CASE("further rays of a job differ from its own, go on where they ended, and are the same again") {
    for (const char* scene : {"@cornell", "@tree-coarse"})
      for (const bool photons : {true, false}) {
        JobRequest request;
        request.scene = scene;
        request.rays = 1000;
        request.keep_scene = true;
        request.field = photons ? sim::Field::photons : sim::Field::isotropic;
        const Job job = make_job(request);
        const sim::Paths more = job.more_rays(1000, 32, 500);
        CHECK(more.rays.size() >= 500);
        CHECK(more.rays.front().origin != job.rays.front().origin);
        CHECK(job.more_rays(1000, 32, 500).rays.front().origin == more.rays.front().origin);
        CHECK(job.more_rays(1500, 33, 500).rays.front().origin != more.rays.front().origin);
        if (photons) continue;
        request.rays = 1500;
        CHECK(make_job(request).rays[1000].origin == more.rays.front().origin);
      }
    JobRequest forgotten;
    forgotten.scene = "@cornell";
    forgotten.rays = 100;
    CHECK_THROWS_AS(static_cast<void>(make_job(forgotten).more_rays(100, 1, 10)), std::invalid_argument);
  }

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
        errors.add(found.outcome, found.outcome.hits, found.batch.photons);
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
      sim::BandResults found_batch;
      found_batch.irradiance = {0, 0, unit};
      found_batch.standard_error = {none, none, none};
      found_batch.upper_bound = {3 * unit, 3 * unit, 4.744 * unit};
      errors.add(found_batch, std::vector<std::uint64_t>{0, 0, 1}, 100);
      found_batch.irradiance = {unit, 0, unit};
      found_batch.upper_bound = {4.744 * unit, 3 * unit, 4.744 * unit};
      errors.add(found_batch, std::vector<std::uint64_t>{1, 0, 1}, 100);
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
