#include <doctest/doctest.h>
#include <fmt/format.h>

#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/choice/candidate_json.hpp"
#include "detp/validate/choice/choice.hpp"
#include "detp/validate/choice/plan.hpp"
#include "detp/validate/job/job.hpp"
#include "support/command.hpp"

using namespace detp;

TEST_SUITE("identity") {
  TEST_CASE("detp run, a plan that is executed once, and choose(Question) choose the same, with the same prediction" *
            doctest::test_suite("long")) {
    int piloted = 0;
    for (const char* scene : {"@cornell", "@tree-coarse", "@interior"})
      for (const double rays : {20.0, 3000.0, 300'000.0}) {
        CAPTURE(scene);
        CAPTURE(rays);
        const auto run = support::result_of(
            fmt::format("run {} --rays {} --disc-radius 2% --calibration none --threads 1", scene, rays));
        validate::JobRequest request;
        request.scene = scene;
        request.rays = rays;
        request.disc_radius = validate::Length{0.02, true};
        const validate::Job job = validate::make_job(request);
        const auto plan = validate::plan(job.discs, job.rays, {.once = true});
        CHECK(run["technique"] == name(plan.candidate().technique));
        CHECK(run["parameters"] == nlohmann::json(to_json(plan.candidate())));
        const sim::Problem& problem = job.problem();
        const auto choice = validate::choose({.problem = &problem, .purpose = validate::Purpose::one_search},
                                             validate::built_in_unit_costs());
        CHECK(plan.candidate() == choice.best().candidate);
        CHECK(plan.threads() == choice.best().threads);
        CHECK(plan.predicted_seconds() == doctest::Approx(choice.best().seconds()));
        piloted += choice.sampled_rays > 0 ? 1 : 0;
      }
    CHECK(piloted >= 3);
  }

  TEST_CASE("predicted seconds of a given technique contain what summing different powers costs, too") {
    const auto run = support::result_of(
        "run @interior --rays 3000 --disc-radius 2% --technique box-tree --fan-out 8 --leaf 8 --threads 1 "
        "--calibration none");
    Counts<double> counts;
    for (const auto& [name, term] : count_terms<double>)
      if (run["predicted"].contains(name)) counts.*term = run["predicted"][std::string(name)];
    const CostTable costs = validate::built_in_unit_costs();
    const double with_sums = price(counts, validate::costs_of_sums(costs), Technique::box_tree).total();
    CHECK(run["predicted_seconds"] == doctest::Approx(with_sums));
    CHECK(with_sums > 1.01 * price(counts, costs, Technique::box_tree).total());
  }
}
