#include "detp/validate/job/job.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/technique/streamed.hpp"
#include "support/disc_ply.hpp"
#include "support/memory_limit.hpp"
#include "support/scratch_file.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

JobRequest three_discs(const char* scene, double rays) {
  JobRequest request;
  request.scene = scene;
  request.rays = rays;
  request.samples = 3;
  request.disc_radius = Length{0.3};
  return request;
}

}  // namespace

TEST_SUITE("statistics") {
  TEST_CASE("the workload of rays that stay in their file is measured on all parts of the file") {
    constexpr int discs = 100'000;
    constexpr int rays = 200'000;
    const support::ScratchFolder folder;
    std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(rays) + "\n";
    for (const char* const name : {"ox", "oy", "oz", "dx", "dy", "dz", "length"})
      ply += std::string("property double ") + name + "\n";
    ply += "end_header\n";
    for (int i = 0; i < rays; ++i) {
      const double ray[] = {0.5, 0.5, 0.5, 0, 0, 1, i < rays / 2 ? 0.01 : 0.03};
      ply.append(reinterpret_cast<const char*>(ray), sizeof(ray));
    }
    JobRequest request;
    request.disc_file =
        folder.file("discs.ply", support::disc_ply(sim::uniform_discs(sim::Body::cube, 1, discs, 0.01, 3)));
    request.ray_file = folder.file("rays.ply", ply);
    request.effects = sim::EffectSelection("all");
    request.stream = request.store_discs = true;
    const support::MemoryLimit limit(16.0 * (1 << 20));
    const Job job = make_job(request);
    REQUIRE(job.stream);
    CHECK(job.workload().path_length == doctest::Approx(0.02).epsilon(0.02));
  }
}

TEST_SUITE("identity") {
  TEST_CASE("a job whose rays fill more than a block can be a stream, of the same rays and the same workload" *
            doctest::test_suite("long")) {
    JobRequest request = three_discs("@uniform", 0x1p20 + 1);
    const Job in_memory = make_job(request);
    request.stream = true;
    const Job job = make_job(request);
    REQUIRE(job.stream);
    CHECK(job.rays.empty());
    CHECK(job.stream->size() == in_memory.rays.size());
    CHECK(job.workload().rays == in_memory.workload().rays);
    CHECK(job.workload().path_length == in_memory.workload().path_length);
    CHECK_THROWS_AS(static_cast<void>(job.problem()), std::invalid_argument);
    const Candidate grid{Technique::grid, GridParameters{2}};
    const sim::StreamedOutcome streamed = sim::run_streamed(job.discs, *job.stream, grid);
    CHECK(streamed.block == 1U << 18);
    CHECK(streamed.outcome.irradiance == sim::run(in_memory.problem(), grid).irradiance);
  }

  TEST_CASE("the workload alone needs only some rays, however many are requested, and is the same" *
            doctest::test_suite("long")) {
    JobRequest request = three_discs("@uniform", 0x1p20 + 1);
    request.stream = true;
    const Job stream = make_job(request);
    request.stream = false;
    request.workload_only = true;
    const Job job = make_job(request);
    CHECK(job.rays.size() == rays_of_workload);
    CHECK(job.workload().rays == 0x1p20 + 1);
    CHECK(job.workload().path_length == stream.workload().path_length);
    request.rays = 1e15;
    CHECK(make_job(request).workload().rays == 1e15);
  }

  TEST_CASE("rays that fill no more than a block are in memory") {
    JobRequest request = three_discs("@uniform", 1000);
    request.stream = true;
    const Job job = make_job(request);
    CHECK(job.rays.size() == 1000);
    CHECK_FALSE(job.stream);
  }
}
