#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "detp/model/rank/predict.hpp"
#include "detp/sim/effects/observe.hpp"
#include "detp/validate/job/job.hpp"

using namespace detp;

namespace {

/// Predicted over counted tests of a box tree, or its inverse, whichever is larger.
double off_by(const validate::Job& job, const Workload& workload, const Counts<std::uint64_t>& counted) {
  const Counts<double> predicted = model::predict(workload, Candidate{Technique::box_tree, BoxTreeParameters{8, 16}});
  const double ratio =
      (predicted.cull_tests + predicted.disc_tests) / static_cast<double>(counted.cull_tests + counted.disc_tests);
  INFO(job.name, " ratio ", ratio);
  return std::max(ratio, 1 / ratio);
}

}  // namespace

TEST_SUITE("statistical") {
  TEST_CASE(
      "with the effects that evidence calls for, tests of box trees are predicted within 60 %, without them not") {
    std::vector<double> with;
    std::vector<double> without;
    for (const char* scene : {"@tree", "@courtyard", "@cornell"})
      for (const double radius : {0.0025, 0.02}) {
        validate::JobRequest request;
        request.scene = scene;
        request.rays = 20'000;
        request.disc_radius = validate::Length{radius, true};
        const validate::Job job = validate::make_job(request);
        const sim::Problem& problem = job.problem();
        const auto counted = sim::run(problem, Candidate{Technique::box_tree, BoxTreeParameters{8, 16}}, {}).counts;
        with.push_back(off_by(job, job.workload(), counted));
        const sim::EffectSelection two("surface-samples,finite-paths");
        without.push_back(off_by(job, sim::observe(problem, job.surface, two).workload, counted));
      }
    std::sort(with.begin(), with.end());
    std::sort(without.begin(), without.end());
    CHECK(with[2] < 1.25);
    CHECK(with.back() < 1.6);
    CHECK(without.back() > 2);
  }
}
