#include "detp/validate/job/job.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "detp/sim/estimate/estimate.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/streamed.hpp"
#include "detp/validate/job/outliers.hpp"
#include "support/machine.hpp"
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

/// Mean irradiance of the discs, over that of the photons that land around the samples.
double over_landings(const std::string& scene, double radius, const char* effects, bool front_facing,
                     bool second_intersection = false) {
  validate::JobRequest request;
  request.scene = scene;
  request.disc_radius = validate::Length{radius, true};
  request.rays = 400'000;
  request.keep_scene = true;
  request.front_facing = front_facing;
  request.second_intersection = second_intersection;
  request.effects = sim::EffectSelection(effects);
  const validate::Job job = validate::make_job(request);
  const Candidate tree{Technique::box_tree, BoxTreeParameters{8, 16}};
  const auto irradiance_of = [&](sim::Estimator estimator) {
    double sum = 0;
    for (const double one :
         sim::estimate(job.problem(), {.estimator = estimator, .candidate = tree, .mesh = &job.scene->mesh}, {})
             .irradiance)
      sum += std::isfinite(one) ? one : 0;
    return sum;
  };
  return irradiance_of(sim::Estimator::disc) / irradiance_of(sim::Estimator::area_corrected);
}

std::vector<sim::Disc> many_discs(sim::Body body = sim::Body::cube) {
  return sim::uniform_discs(body, 2, 10'000, 0.02, 1);
}

std::vector<sim::Ray> lines_through(const std::vector<sim::Disc>& discs) {
  return sim::LineField(sim::enclosing_sphere(discs), 1).lines(0, 100);
}

std::vector<std::string> warnings_of(const std::vector<sim::Disc>& discs) {
  const auto rays = lines_through(discs);
  return outlier_warnings(sim::make_problem(rays, discs));
}

void check_one(const std::vector<std::string>& warnings, const std::vector<std::string>& named) {
  REQUIRE(warnings.size() == 1);
  CAPTURE(warnings[0]);
  for (const std::string& part : named) CHECK(warnings[0].find(part) != std::string::npos);
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

  TEST_CASE("with the effect off, paths have the bytes of paths that end at surfaces") {
    validate::JobRequest request;
    request.scene = "@cornell";
    request.rays = 3000;
    request.effects = sim::EffectSelection("none");
    const validate::Job job = validate::make_job(request);
    const sim::Scene scene = sim::open_scene({.name = "@cornell", .samples = {}});
    const std::vector<sim::Ray> expected = sim::photon_paths(scene, 3000, 1).rays;
    REQUIRE(job.rays.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      CHECK(job.rays[i].origin == expected[i].origin);
      CHECK(job.rays[i].length == expected[i].length);
    }
  }
}

TEST_SUITE("scenes") {
  TEST_CASE("the bunny's discs have the light that lands around them, and lose a quarter if paths end at surfaces") {
    const std::string folder = support::scenes_folder();
    if (folder.empty()) return;
    CHECK(over_landings(folder + "/stanford_bunny.obj", 0.01, "auto", true) == doctest::Approx(1).epsilon(0.05));
    CHECK(over_landings(folder + "/stanford_bunny.obj", 0.01, "none", true) < 0.8);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("light inside of a glass ball reaches its discs, and is lost if paths end at surfaces" *
            doctest::test_suite("long")) {
    CHECK(over_landings("@caustic", 0.0025, "auto", false) == doctest::Approx(1).epsilon(0.1));
    CHECK(over_landings("@caustic", 0.0025, "none", false) < 0.8);
  }

  TEST_CASE("paths to the second intersection, as in the paper, also reach discs behind sheets" *
            doctest::test_suite("long")) {
    CHECK(over_landings("@cornell", 0.01, "none", false, true) > 1.1 * over_landings("@cornell", 0.01, "auto", false));
    validate::JobRequest lines;
    lines.scene = "@cornell";
    lines.field = sim::Field::isotropic;
    lines.second_intersection = true;
    CHECK_THROWS_AS(static_cast<void>(validate::make_job(lines)), std::invalid_argument);
  }

  TEST_CASE("paths go on through surfaces where the evidence calls for it, and where they are told to") {
    const auto length = [](const char* effects, const char* scene) {
      validate::JobRequest request;
      request.scene = scene;
      request.rays = 5000;
      request.front_facing = true;
      request.effects = sim::EffectSelection(effects);
      const validate::Job job = validate::make_job(request);
      double sum = 0;
      for (const sim::Ray& ray : job.rays) sum += ray.length;
      return sum;
    };
    CHECK(length("auto", "@cornell") == length("concave-surfaces", "@cornell"));
    CHECK(length("auto", "@cornell") > length("none", "@cornell"));
    CHECK(length("auto", "@tree-coarse") == length("none", "@tree-coarse"));
    CHECK(length("concave-surfaces", "@tree-coarse") > length("none", "@tree-coarse"));
  }

  TEST_CASE("whether paths go on depends neither on the radius nor on samples and seed" * doctest::test_suite("long")) {
    for (const char* scene : {"@cornell", "@tree-coarse"}) {
      std::vector<double> values;
      for (const double radius : {0.002, 0.02, 0.2})
        for (const std::uint64_t seed : {1, 2}) {
          validate::JobRequest request;
          request.scene = scene;
          request.rays = 500;
          request.samples = 100 * static_cast<double>(seed);
          request.disc_radius = {radius, true};
          request.seed = seed;
          values.push_back(validate::make_job(request).surface.self_shadow->value);
        }
      for (const double value : values) CHECK(value == values[0]);
    }
  }

  TEST_CASE("the evidence is reported for photon paths, and is 0 for lines and for rays that are given") {
    for (const sim::Field field : {sim::Field::isotropic, sim::Field::photons}) {
      validate::JobRequest request;
      request.scene = "@cornell";
      request.rays = 1000;
      request.front_facing = true;
      request.field = field;
      const validate::Job job = validate::make_job(request);
      for (const sim::EffectReport& report : job.observed().effects) {
        if (report.effect != &sim::concave_surfaces) continue;
        CHECK(report.on == (field == sim::Field::photons));
        CHECK((report.value > 0) == (field == sim::Field::photons));
      }
    }
  }

  TEST_CASE("one large disc among small ones is named, with the radius that the models use for all") {
    auto discs = many_discs();
    discs[77].radius = 50;
    check_one(warnings_of(discs),
              {"1 of 10000 discs has a radius of 50", "2.5e+03 times the median 0.02", "root mean square 0.5004"});
    for (std::size_t i = 0; i < 100; ++i)
      discs[100 * i].radius = 0.1;  // five times the median: the mean square changes by a fifth
    discs[77].radius = 0.02;
    check_one(warnings_of(discs), {"100 of 10000 discs have radii up to 0.1"});
  }

  TEST_CASE("the warning of one disc far away, or one in a hundred, has the sizes of the boxes") {
    for (const sim::Body body : {sim::Body::cube, sim::Body::cube_faces}) {
      auto discs = many_discs(body);
      discs[5].centre = {0, 2000, 0};
      check_one(warnings_of(discs), {"1 of 10000 discs lies far from the others", "2e+03 long", "percentages"});
      for (std::size_t i = 0; i < 100; ++i) discs[100 * i + 5].centre = {30, 0, 0};
      check_one(warnings_of(discs), {"100 of 10000 discs lie far from the others"});
    }
  }

  TEST_CASE("the warning of a ray that starts far outside has its distance; a ray that starts near has no warning") {
    const auto discs = many_discs();
    auto rays = lines_through(discs);
    rays[3].origin = {1e6, 0, 0};
    check_one(outlier_warnings(sim::make_problem(rays, discs)), {"1 of 100 rays starts far outside", "1e+06", "S0"});
    rays[3].origin = {20, 0, 0};
    CHECK(outlier_warnings(sim::make_problem(rays, discs)).empty());
  }

  TEST_CASE("all three at once give three warnings") {
    auto discs = many_discs();
    auto rays = lines_through(discs);
    discs[77].radius = 50;
    discs[5].centre = {0, 2000, 0};
    rays[3].origin = {1e9, 0, 0};
    CHECK(outlier_warnings(sim::make_problem(rays, discs)).size() == 3);
  }

  TEST_CASE("ordinary sets give no warning: uniform, on faces, few, in one place, radii within a factor of four") {
    CHECK(warnings_of(many_discs()).empty());
    CHECK(warnings_of(many_discs(sim::Body::cube_faces)).empty());
    auto discs = many_discs();
    for (std::size_t i = 0; i < discs.size(); ++i) discs[i].radius *= 1 + 3 * static_cast<double>(i % 100) / 100;
    CHECK(warnings_of(discs).empty());
    for (sim::Disc& disc : discs) disc.centre = {1, 2, 3};
    CHECK(warnings_of(discs).empty());
    CHECK(warnings_of(std::vector<sim::Disc>(1)).empty());
    CHECK(warnings_of({{}, {.centre = {5, 5, 5}}, {.centre = {5, 6, 5}}}).empty());
  }

  TEST_CASE("built-in scenes give no warning" * doctest::test_suite("long")) {
    for (const std::string name :
         {"@uniform", "@tree", "@tree-coarse", "@courtyard", "@cornell", "@caustic", "@interior"}) {
      CAPTURE(name);
      JobRequest request;
      request.scene = name;
      request.rays = 1000;
      CHECK(make_job(request).warnings.empty());
    }
  }
}
