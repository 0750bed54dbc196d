#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "detp/sim/technique/technique.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/choice/pilot.hpp"
#include "detp/validate/job/job.hpp"
#include "support/scratch_file.hpp"
#include "support/sparse_scenes.hpp"

using namespace detp;

namespace {

constexpr std::array judged{&Counts<double>::cull_tests, &Counts<double>::culls,      &Counts<double>::listed,
                            &Counts<double>::visits,     &Counts<double>::disc_tests, &Counts<double>::hits};

/// How many counts of choices are within two stated errors.
struct Coverage {
  int all = 0;
  int inside = 0;
  int wrong_without_error = 0;

  void add(const Prediction& choice, const Counts<double>& counted) {
    for (const auto term : judged) {
      const double off = std::abs(choice.counts.*term - counted.*term);
      const double error = choice.counts_error.*term;
      ++all;
      inside += off <= 2 * error + 1e-6 * counted.*term ? 1 : 0;
      wrong_without_error += error == 0 && off > 0 ? 1 : 0;
    }
  }
};

void search_sparse(const std::string& mesh, std::uint64_t seed, Coverage& coverage) {
  const support::ScratchFolder folder;
  validate::JobRequest request;
  request.scene = folder.file("scene.obj", mesh);
  request.rays = 30'000 + 10'000 * static_cast<double>(seed % 4);
  request.disc_radius = validate::Length{std::array{0.002, 0.006, 0.035}[seed % 3], true};
  request.field = seed % 4 == 0 ? sim::Field::isotropic : sim::Field::photons;
  request.effects = sim::EffectSelection("none");
  request.seed = seed;
  const validate::Job job = validate::make_job(request);
  const sim::Problem& problem = job.problem();
  const auto found =
      validate::choose({.problem = &problem, .workload = job.workload(), .disabled = {Technique::brute_force}},
                       validate::built_in_unit_costs());
  CAPTURE(seed);
  REQUIRE(found.best().candidate.technique == Technique::box_tree);
  coverage.add(found.best(), as_expected(sim::run(problem, found.best().candidate).counts));
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE(
      "where few rays reach the discs, nine of ten counts are within two stated errors, and no wrong count is exact") {
    Coverage coverage;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      search_sparse(support::tiny_object(seed), seed, coverage);
      search_sparse(support::furnished_floor(seed), seed, coverage);
    }
    CHECK(coverage.all == 96);
    CHECK(coverage.inside >= 0.9 * coverage.all);
    CHECK(coverage.wrong_without_error == 0);
  }

  TEST_CASE("where few rays reach the discs, a pilot that has no other rays to draw from states a larger error") {
    const support::ScratchFolder folder;
    int larger = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      validate::JobRequest request;
      request.scene = folder.file("scene.obj", support::tiny_object(seed));
      request.rays = 40'000;
      request.disc_radius = validate::Length{0.02, true};
      request.effects = sim::EffectSelection("none");
      const validate::Job job = validate::make_job(request);
      const sim::Problem& problem = job.problem();
      const auto costs = validate::built_in_unit_costs();
      const auto with = validate::choose(
          {.problem = &problem, .workload = job.workload(), .disabled = {Technique::brute_force}}, costs);
      const auto sample = validate::pilot_sample(problem.rays(), problem.discs().size());
      const sim::Problem without_rays = sim::make_problem_without_rays(job.discs, problem.farthest());
      const auto without = validate::choose({.problem = &without_rays,
                                             .rays = sample,
                                             .ray_count = static_cast<double>(job.rays.size()),
                                             .workload = job.workload(),
                                             .disabled = {Technique::brute_force}},
                                            costs);
      CHECK(with.best().counts_error.disc_tests > 0);
      larger += without.best().counts_error.disc_tests > 1.2 * with.best().counts_error.disc_tests ? 1 : 0;
    }
    CHECK(larger >= 2);
  }
}
