#include "detp/validate/choice/comparison.hpp"

#include <doctest/doctest.h>

#include "detp/validate/job/job.hpp"

namespace detp::validate {
namespace {

Job room() {
  JobRequest request;
  request.scene = "@cornell";
  request.rays = 2000;
  return make_job(request);
}

}  // namespace

TEST_SUITE("effects") {
  TEST_CASE("one short search is not worth evidence: its workload has no effects, unless they are selected by hand") {
    const Job job = room();
    Question question{.problem = &job.problem(), .purpose = Purpose::one_search};
    CHECK(evidence(question, 2000).dimension == 3);
    CHECK(evidence(question, 2000).rays_end);
    CHECK(evidence(question, 2000).path_length == 0);
    question.effects = sim::EffectSelection("surface-samples");
    CHECK(evidence(question, 2000).dimension < 2.9);
  }

  TEST_CASE("one long search, and many, are worth evidence") {
    const Job job = room();
    Question question{.problem = &job.problem(), .purpose = Purpose::one_search};
    CHECK(evidence(question, 1e7).dimension < 2.9);
    CHECK(evidence(question, 1e7).rays == 1e7);
    question.purpose = Purpose::replans;
    CHECK(evidence(question, 2000).dimension < 2.9);
  }
}

}  // namespace detp::validate
