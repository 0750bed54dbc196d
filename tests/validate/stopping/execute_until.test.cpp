#include "detp/validate/stopping/execute_until.hpp"

#include <doctest/doctest.h>

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
