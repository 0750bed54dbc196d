#include "detp/validate/stopping/execute_until.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "detp/validate/job/job.hpp"

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
}

}  // namespace detp::validate
